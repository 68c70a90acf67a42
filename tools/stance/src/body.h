// How the forces of the feet follow from where the feet are: the body has found its equilibrium in between.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "brace/stance.h"

namespace brace::stance {

constexpr int limbs_most = BRACE_STANCE_LIMBS;

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat36 = Eigen::Matrix<double, 3, 6>;
using Mat63 = Eigen::Matrix<double, 6, 3>;
using Places = std::array<Vec3, limbs_most>; // of feet [mm] or their forces [N], limb by limb

// The matrix that makes a x b of b.
inline Mat3 cross(const Vec3 &a)
{
    Mat3 m;
    m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
    return m;
}

inline Vec3 vec3(const double *of)
{
    return Vec3(of[0], of[1], of[2]);
}

inline Mat3 mat3(const double *rows)
{
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows);
}

// A load [N, N mm], and how its moment changes by each radian [N mm].
struct Load {
    Vec6 wrench;
    Mat3 turning;
};

inline Load load_of(const brace_stance_load_t &load)
{
    Load made;
    made.wrench << vec3(load.force_n), vec3(load.moment_n_mm);
    made.turning = mat3(load.turning_n_mm);
    return made;
}

// The body on those limbs whose feet are on the ground, to first order in the displacements of body and feet.
//
//   force_i = K_i v_i - H_i u + e_i        H_i = K_i [1, -[r_i]x] + [0, [f0_i]x]     e_i = f0_i - K_i d0_i
//   A u     = sum B_i v_i + sum J_i' e_i + w           B_i = J_i' K_i - [0; [f0_i]x],   J_i = [1, -[r_i]x]
//
// v: the feet's places, u: the body's translation and rotation, w: the load, r: foot_mm, f0 and d0: force and move of
// the tip that K belongs to. A is the body's stiffness with the feet held; [f0]x is what a preloaded foot adds when the
// body turns and when the foot moves from below it.
class Body {
public:
    // bears: which limbs are on the ground. Returns false if they do not hold the body.
    bool assemble(const brace_stance_t &stance, const Load &load, const std::array<bool, limbs_most> &bears);

    // Where the body is, and what the ground's forces are, when the feet are at these places.
    Vec6 displacement(const Places &feet, const Vec6 &wrench) const;
    Vec3 force(int limb, const Vec3 &foot, const Vec6 &body) const
    {
        return k_[limb] * foot - h_[limb] * body + e_[limb];
    }

    // Change of a limb's force with the place of another limb's foot [N/mm]; both on the ground.
    Mat3 stiffness(int limb, int by_foot) const
    {
        Mat3 s = -h_[limb] * moves_[by_foot];
        if (limb == by_foot) {
            s += k_[limb];
        }
        return s;
    }

    bool bears(int limb) const { return bears_[limb]; }
    int count() const { return count_; }

private:
    int count_ = 0;
    std::array<bool, limbs_most> bears_{};
    std::array<Mat3, limbs_most> k_;
    std::array<Mat36, limbs_most> h_;
    std::array<Vec3, limbs_most> e_;
    std::array<Mat63, limbs_most> moves_; // of the body by a foot
    Mat6 compliance_;
    Vec6 at_rest_;
};

// Where a foot without force is when the body is there, from foot_mm.
Vec3 hanging_place(const brace_stance_limb_t &limb, const Vec6 &body);

} // namespace brace::stance
