// The planar and the spatial K with Eigen's fixed-size matrices and direct eigenvalue solvers.
#include "peer_eigen.hpp"

#include <Eigen/Dense>

#include <cmath>

namespace {

using Eigen::Matrix2f;
using Eigen::Matrix3f;
using Eigen::Rotation2Df;
using Eigen::Vector2f;

Vector2f turned(const Vector2f &v)
{
    return {-v.y(), v.x()};
}

// Compliance of a link at the tip; arm: from its far end to the tip.
Matrix2f beam(const plain_link_t &link, const Matrix2f &frame, const Vector2f &arm)
{
    Matrix2f c = frame * Vector2f(link.axial, link.bending).asDiagonal() * frame.transpose();
    if (link.moment_transfer != 0.0f) {
        const float b = link.bending * link.moment_transfer;
        const Vector2f lever = turned(arm);
        const Matrix2f coupling = 1.5f * b / link.length * frame.col(1) * lever.transpose();
        c += coupling + coupling.transpose() + 3.0f * b / (link.length * link.length) * lever * lever.transpose();
    }
    return c;
}

Matrix2f spring(float compliance, const Vector2f &arm)
{
    const Vector2f lever = turned(arm);
    return compliance * lever * lever.transpose();
}

float lateral(const plain_link_t &link, float reach)
{
    const float t = 3.0f * link.moment_transfer / link.length;
    return link.lateral * (1.0f + t * reach + t / link.length * reach * reach);
}

} // namespace

void eigen_stiffness(const plain_limb_t &limb, float theta1, float theta2, plain_stiffness_t &out)
{
    const Matrix2f femur = Rotation2Df(theta1).toRotationMatrix();
    const Matrix2f tibia = Rotation2Df(theta1 - theta2).toRotationMatrix();
    const Vector2f shank = limb.tibia.length * tibia.col(0);
    const Vector2f tip = limb.femur.length * femur.col(0) + shank;

    const Matrix2f c = beam(limb.femur, femur, shank) + beam(limb.tibia, tibia, Vector2f::Zero()) +
                       spring(limb.joint[1], tip) + spring(limb.joint[2], shank);
    const Matrix2f k = c.inverse();

    Eigen::SelfAdjointEigenSolver<Matrix2f> solver;
    solver.computeDirect(k);
    const Vector2f stiff = solver.eigenvectors().col(1);
    out.k_xx = k(0, 0);
    out.k_xz = k(0, 1);
    out.k_zz = k(1, 1);
    out.lambda_min = solver.eigenvalues()(0);
    out.lambda_max = solver.eigenvalues()(1);
    out.stiff_axis = std::atan2(stiff.y(), stiff.x());
}

void eigen_spatial_stiffness(const plain_limb_t &limb, float theta0, float theta1, float theta2, plain_spatial_t &out)
{
    const Matrix2f femur = Rotation2Df(theta1).toRotationMatrix();
    const Matrix2f tibia = Rotation2Df(theta1 - theta2).toRotationMatrix();
    const Vector2f shank = limb.tibia.length * tibia.col(0);
    const Vector2f tip = limb.femur.length * femur.col(0) + shank;

    const Matrix2f plane = beam(limb.coxa, Matrix2f::Identity(), tip) + beam(limb.femur, femur, shank) +
                           beam(limb.tibia, tibia, Vector2f::Zero()) + spring(limb.joint[1], tip) +
                           spring(limb.joint[2], shank);
    const float along = shank.dot(femur.col(0)), across = shank.dot(femur.col(1));
    const float reach = limb.coxa.length + tip.x();

    Matrix3f c = Matrix3f::Zero();
    c(0, 0) = plane(0, 0);
    c(0, 2) = c(2, 0) = plane(0, 1);
    c(2, 2) = plane(1, 1);
    c(1, 1) = limb.joint[0] * reach * reach + lateral(limb.coxa, tip.x()) + limb.coxa.torsion * tip.y() * tip.y() +
              lateral(limb.femur, along) + limb.femur.torsion * across * across + limb.tibia.lateral;

    Matrix3f turn = Matrix3f::Identity();
    turn.topLeftCorner<2, 2>() = Rotation2Df(theta0).toRotationMatrix();
    const Matrix3f k = turn * c.inverse() * turn.transpose();

    Eigen::SelfAdjointEigenSolver<Matrix3f> solver;
    solver.computeDirect(k);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out.k[i][j] = k(i, j);
        }
        out.lambda[i] = solver.eigenvalues()(i);
        out.stiff_axis[i] = solver.eigenvectors()(i, 2);
    }
}
