// One step from a state to a load: which feet stick, slide or are off the ground, and where the sliding ones come to.
#pragma once

#include "body.h"

namespace brace::stance {

// A foot's ground: its normal and two directions along it.
struct Ground {
    Vec3 normal;
    Eigen::Matrix<double, 3, 2> along;
};

Ground ground_of(const brace_stance_limb_t &limb);

// What is found for a load.
struct Rest {
    Vec6 body;
    Places place, force;
    std::array<int32_t, limbs_most> contact;
};

// The equilibrium under a load, each sliding foot moved in one implicit step from where it was: its friction is
// opposite to the whole step. returns OK, E_LOOSE, E_NO_REST.
int32_t step(const brace_stance_t &stance, const Load &load, const brace_stance_state_t &from, Rest &rest);

} // namespace brace::stance
