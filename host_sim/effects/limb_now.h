// The limb at a time and at a temperature. Every effect that changes a number of the limb with either stands in the
// list `Changes`, and nobody else sees time or temperature: the plant works with the numbers that come out. Who keeps
// something and must know whether the limb is still the same compares those numbers, so no effect has to be asked.
#pragma once

#include <cstring>

#include "effects/link_change.h"
#include "effects/thermal_softening.h"

namespace brace::effects {

template <class... Effects> struct ChangesBy {
    static bool act(const Model &model) { return (Effects::acts(model) || ...); }

    static void of_joint(const Model &model, const Conditions &conditions, int joint, Joint &now)
    {
        (call_if_acts<Effects>(model, [&] { Effects::of_joint(model, conditions, joint, now); }), ...);
    }

    static void of_link(const Model &model, const Conditions &conditions, int link, Link &now)
    {
        (call_if_acts<Effects>(model, [&] { Effects::of_link(model, conditions, link, now); }), ...);
    }

private:
    template <class Effect, class Call> static void call_if_acts(const Model &model, const Call &call)
    {
        if (Effect::acts(model)) {
            call();
        }
    }
};

using Changes = ChangesBy<thermal_softening::Change, // with temperature
                          link_change::Change>;      // with time

inline Joint joint_now(const Model &model, const Conditions &conditions, int joint)
{
    Joint now = model.joint[joint];
    Changes::of_joint(model, conditions, joint, now);
    return now;
}

inline Model limb_now(const Model &model, const Conditions &conditions)
{
    Model now = model;
    for (int index = kCoxa; index <= kTibia; ++index) {
        now.joint[index] = joint_now(model, conditions, index);
        Changes::of_link(model, conditions, index, now.link[index]);
    }
    now.thermal = {}; // it has acted
    now.change = {};
    now.sensor = {}; // it reads the limb, and the limb does not feel it
    return now;
}

// Are two limbs the same, number by number?
inline bool is_same(const Model &a, const Model &b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}

// One limb at two times, apart from the springs of its joints. `Changes` reaches joints and links only.
inline bool is_same_but_for_springs(const Model &a, const Model &b)
{
    bool same = std::memcmp(a.link, b.link, sizeof a.link) == 0;
    for (int joint = kCoxa; joint <= kTibia; ++joint) {
        same = same && a.joint[joint].zero_offset_rad == b.joint[joint].zero_offset_rad;
    }
    return same;
}

} // namespace brace::effects
