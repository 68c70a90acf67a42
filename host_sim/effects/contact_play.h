// The tip's ball joint has clearance, and drags the tip along: along each axis the tip stays where it is until the
// clearance is taken up on that side. So the slip depends on which way the rig last moved, not on the force.
// Reads contact.play_mm; depends on the load and what came before.
#pragma once

#include <Eigen/Core>

#include "effects/effect.h"

namespace brace::effects::contact_play {

// When the socket moves to a displacement, the tip follows no further than half the clearance behind it.
template <int N>
Eigen::Matrix<double, N, 1> dragged_mm(const Model &model, const Eigen::Matrix<double, N, 1> &tip_mm,
                                       const Eigen::Matrix<double, N, 1> &socket_mm)
{
    const double half = 0.5 * model.contact.play_mm;
    return tip_mm.array().max(socket_mm.array() - half).min(socket_mm.array() + half);
}

} // namespace brace::effects::contact_play
