/* take_up_and_let_go BUS NODE JOINT FLANK [KEY_FILE]: takes up the play of a joint (1 femur, 2 tibia) against a flank
 * (1 or -1), prints K of that flank, and lets go. The limb moves by its play.
 *   take_up_and_let_go can0 1 2 -1 | take_up_and_let_go tcp://127.0.0.1:29536 1 2 -1 limb.key */
#include <stdio.h>
#include <stdlib.h>

#include <brace/client_motion.h>

#include "connect.h"

enum { ANSWER_MS = 500, LIMIT_MS = 30000 };

/* A robot would call brace_client_step in its control loop instead, at least every 50 ms. */
static brace_client_status_t take_up(brace_client_t *limb, uint32_t joint, int flank)
{
    const brace_client_status_t asked = brace_client_begin_take_up(limb, joint, flank, ANSWER_MS, LIMIT_MS);
    return asked == BRACE_CLIENT_OK ? brace_client_wait(limb, NULL) : asked;
}

static brace_client_status_t let_go(brace_client_t *limb)
{
    const brace_client_status_t asked = brace_client_begin_let_go(limb, ANSWER_MS, LIMIT_MS);
    return asked == BRACE_CLIENT_OK ? brace_client_wait(limb, NULL) : asked;
}

int main(int argc, char **argv)
{
    if (argc < 5) {
        fprintf(stderr, "usage: %s BUS NODE JOINT FLANK [KEY_FILE]\n", argv[0]);
        return 2;
    }
    brace_client_t *limb = connect_limb(argc, argv);
    brace_client_snapshot_t now;
    brace_client_status_t status = argc > 5 ? brace_client_load_key(limb, argv[5]) : BRACE_CLIENT_OK;
    if (status == BRACE_CLIENT_OK) {
        status = take_up(limb, (uint32_t)atoi(argv[3]), atoi(argv[4]));
    }
    if (status == BRACE_CLIENT_OK) {
        status = brace_client_read(limb, BRACE_PART_K, 2000, &now);
    }
    if (status == BRACE_CLIENT_OK) {
        printf("held: k_xx %.4f k_xz %.4f k_zz %.4f N/mm, flags 0x%02x\n", now.k_xx_n_per_mm, now.k_xz_n_per_mm,
               now.k_zz_n_per_mm, (unsigned)now.flags);
        status = let_go(limb);
    }
    return disconnect_limb(limb, status);
}
