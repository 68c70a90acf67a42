/* The bench's limb in the peers' own layout. Expects bench_data.h before it. */
#ifndef PEER_PLAIN_LIMB_H
#define PEER_PLAIN_LIMB_H

#include "brace/limb.h"
#include "plain.h"

#ifndef BENCH_PEER_LIMB
#define BENCH_PEER_LIMB BENCH_PAPER_LIMB
#endif

static inline plain_link_t plain_link(const brace_link_t *link, float length)
{
    plain_link_t copy = {length,
                         link->axial_mm_per_n,
                         link->bending_mm_per_n,
                         link->lateral_mm_per_n,
                         link->torsion_rad_per_n_mm,
                         link->moment_transfer};
    return copy;
}

static inline void plain_limb_from_bench(plain_limb_t *limb)
{
    static const brace_limb_t bench = BENCH_PEER_LIMB;
    limb->coxa = plain_link(&bench.link[BRACE_COXA], bench.coxa_mm);
    limb->femur = plain_link(&bench.link[BRACE_FEMUR], bench.femur_mm);
    limb->tibia = plain_link(&bench.link[BRACE_TIBIA], bench.tibia_mm);
    for (int i = 0; i < 3; i++) {
        limb->joint[i] = bench.joint[i].compliance_rad_per_n_mm;
    }
}

#endif
