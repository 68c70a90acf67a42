// Four copies of one limb at finite displacements. They take their steps at the same time, each copy in its own lane.
// Each copy may play another run of a record if no run depends on the runs before it. A copy finds the same rest states
// as a limb that is played alone, to the last bit.
#pragma once

#include <array>
#include <cstddef>

#include "plant/condensed.h"
#include "plant/lanes.h"
#include "plant/limb_state.h"

namespace brace::plant {

class LimbsAbreast {
public:
    explicit LimbsAbreast(const Model &model);

    LimbState<InPlane> &limb(std::size_t lane) { return limb_[lane]; }

    // One step of each limb that seeks its rest.
    void step();

private:
    void put_in(std::size_t lane);
    void put_in_structure(std::size_t lane);

    std::array<LimbState<InPlane>, kLanes> limb_;
    std::array<unsigned, kLanes> structure_seen_{};
    StructureOf<Lanes> structure_{};
    std::array<JointHingeOf<Lanes>, 2> joint_{};
    CondensedOf<Lanes>::Shape shape_;
    CondensedOf<Lanes> condensed_;
};

} // namespace brace::plant
