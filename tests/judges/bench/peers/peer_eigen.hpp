// K with Eigen; the limb and the results in the same plain structs as the plain C version.
#ifndef PEER_EIGEN_HPP
#define PEER_EIGEN_HPP

#include "plain.h"

void eigen_stiffness(const plain_limb_t& limb, float theta1, float theta2, plain_stiffness_t& out);
void eigen_spatial_stiffness(const plain_limb_t& limb, float theta0, float theta1, float theta2, plain_spatial_t& out);

#endif
