// A chain of hinges and slides, each with a linear spring, under dead loads: rest state, tangent and buckling factor at
// finite displacements. The limb of loaded.h is such a chain, in its plane and in space.
//
// Energy of the deflections q: E(q) = sum k_i q_i^2 / 2 - sum_m f_m . (x_m(q) - x_m(0)). A rest state is a minimum.
// With z_i the axis of a hinge (0 for a slide), h_i its place, F_j the loads beyond spring j and r = x_m - h_j:
//   dx/dq_j           = z_j x r (hinge), u_j (slide)
//   d2x/dq_i dq_j     = z_i x (dx/dq_j)         for i before or equal to j
//   G_ij              = z_i . c_j               c_j = sum_m (z_j x r) x f_m (hinge), u_j x F_j (slide)
//   H                 = diag(k) - G,  C = J H^-1 J',  K = C^-1
// which is the conservative congruence transformation K = J^-T (K_theta - K_G) J^-1 at the loaded chain's rest state.
// Sources: S.-F. Chen, I. Kao, Conservative congruence transformation for joint and Cartesian stiffness matrices of
// robotic hands and fingers, Int. J. Robotics Research 19 (2000); A. Pashkevich, A. Klimchik, D. Chablat, Enhanced
// stiffness modeling of manipulators with passive joints, Mechanism and Machine Theory 46 (2011).
// G is semiseparable of rank 3, so H = L D L' costs a number of operations proportional to the number of springs.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace brace::reference {

using Vector3d = Eigen::Vector3d;
using Matrix3d = Eigen::Matrix3d;

struct Spring {
    bool hinge;
    Vector3d axis; // of a hinge, or direction of a slide: a unit vector at no deflection
    Vector3d point; // of a hinge, at no deflection [mm]
    double stiffness; // N mm/rad or N/mm, > 0
};

struct Weight {
    std::size_t after; // how many springs carry it: the first `after` of the chain
    Vector3d point; // at no deflection [mm]
    Vector3d force_n;
};

struct Chain {
    std::vector<Spring> springs;
    std::vector<Weight> weights; // ordered by `after`
    Vector3d tip; // at no deflection [mm]
};

// The directions in which the tip yields: the first `count` columns; the others are zero. A matrix over them (C, K) has
// its first `count` rows and columns; the rest is zero.
struct Directions {
    Matrix3d axes;
    int count;
};

inline const Directions kInPlane = {(Matrix3d() << 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0).finished(), 2}; // x, z
inline const Directions kInSpace = {Matrix3d::Identity(), 3};

// Of the first `count` rows and columns of a symmetric matrix; the first `count` are valid.
struct Spectrum {
    Vector3d values; // ascending
    Matrix3d vectors;
};

Spectrum spectrum(const Matrix3d &matrix, int count);

// Inverse of the first `count` rows and columns of a symmetric matrix; the rest is zero.
Matrix3d inverse(const Matrix3d &matrix, int count);

// One number, or one vector, for each spring. Eigen's matrices of sizes known at run time take minutes to compile.
using Scalars = std::vector<double>;
using Vectors = std::vector<Vector3d>;

// The chain at some deflections.
struct Placed {
    Vectors axis, point; // of each spring, now
    Vectors weight; // places of the weights, now
    Vector3d tip;
};

Placed place(const Chain &chain, const Scalars &q);

// C without any load.
Matrix3d unloaded_compliance(const Chain &chain, const Directions &directions);

double energy_n_mm(const Chain &chain, const Placed &placed, const Scalars &q, const Vector3d &force_n);

// What spring forces, tip force and weights do at every spring, and the two factors of G.
struct Loaded {
    Scalars load; // sum_m dx_m/dq . f_m: moment about a hinge, force along a slide
    Vectors tip_by_q; // J
    Vectors z, c; // G_ij = z_i . c_j for i <= j
};

Loaded load(const Chain &chain, const Placed &placed, const Vector3d &force_n);

struct RestState {
    Scalars q;
    Placed placed;
    Loaded loaded;
    Vector3d force_n; // of the ground on the tip
    Matrix3d compliance; // over the given directions
    double buckling_factor; // infinity: none
};

// Buckling factors above this are reported as none: rounding of G could make them.
constexpr double kNoBuckling = 1e9;

// The rest state that a descent from the undeflected chain finds under the tip force: Newton's method on the energy.
// Each step is shortened until the energy falls (Armijo), and turns the hinges together by at most half a radian. Where
// H is not positive definite, diag(k) is added to it until it is.
// False: none was found (the load collapses the chain).
bool rest_under_force(const Chain &chain, const Directions &directions, const Vector3d &force_n, RestState &rest);

// The rest state with the tip held at a displacement from its undeflected place: the one that is reached from the rest
// at no tip force when the tip is led there on a straight line. The force is in the span of the directions.
// False: the path ends before (no rest state, or one that is not a minimum among those with the tip held).
bool rest_under_displacement(const Chain &chain, const Directions &directions, const Vector3d &displacement_mm,
                             RestState &rest);

} // namespace brace::reference
