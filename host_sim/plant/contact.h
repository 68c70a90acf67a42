// The tip in its socket: a linear structure reached through a clearance.
#pragma once

#include <Eigen/Core>

namespace brace::plant {

struct ContactForce {
    Eigen::Vector2d force_n;
    Eigen::Matrix2d stiffness_n_per_mm; // d force / d displacement where the clearance is taken up
};

// A structure's compliance with its inverse.
struct Elastic {
    Eigen::Matrix2d compliance_mm_per_n;
    Eigen::Matrix2d stiffness_n_per_mm;
};

Elastic elastic_of(const Eigen::Matrix2d &compliance_mm_per_n);

// Force for a displacement of the socket when the tip slips freely within +-half_play along each axis (infinite: free
// along it): the slip that stores least energy.
ContactForce contact_force(const Elastic &structure, const Eigen::Vector2d &half_play_mm,
                           const Eigen::Vector2d &displacement_mm);

}  // namespace brace::plant
