#include "body.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace brace::stance {

namespace {

constexpr double loose_share = 1e-9; // a pivot below this share of its diagonal is rounding

// Is a symmetric 3 x 3 matrix positive definite, to rounding of these sizes?
bool is_positive(const Mat3 &matrix, const Vec3 &sizes)
{
    const Eigen::LLT<Mat3> parts(matrix);
    const Vec3 roots = parts.matrixLLT().diagonal();
    return parts.info() == Eigen::Success && (roots.array().square() > loose_share * sizes.array()).all();
}

// The inverse of a 6 x 6 matrix by its 3 x 3 blocks; false: the body does not resist every displacement, because the
// symmetric part is not positive definite.
bool invert(const Mat6 &stiffness, Mat6 &inverse)
{
    const Mat3 slides = stiffness.topLeftCorner<3, 3>(), slides_by_turn = stiffness.topRightCorner<3, 3>();
    const Mat3 turns_by_slide = stiffness.bottomLeftCorner<3, 3>(), turns = stiffness.bottomRightCorner<3, 3>();
    if (!is_positive(slides, slides.diagonal())) { // a sum of limbs' K, so symmetric
        return false;
    }
    const Mat3 per_slide = slides.inverse();
    const Mat3 coupled = 0.5 * (slides_by_turn + turns_by_slide.transpose());
    const Mat3 held = 0.5 * (turns + turns.transpose()) - coupled.transpose() * per_slide * coupled;
    if (!is_positive(held, turns.diagonal())) {
        return false;
    }
    const Mat3 left = per_slide * slides_by_turn;
    const Mat3 per_turn = (turns - turns_by_slide * left).inverse(), right = turns_by_slide * per_slide;
    inverse << per_slide + left * per_turn * right, -left * per_turn, -per_turn * right, per_turn;
    return true;
}

} // namespace

bool Body::assemble(const brace_stance_t &stance, const Load &load, const std::array<bool, limbs_most> &bears)
{
    count_ = stance.limb_count;
    bears_ = bears;
    Mat6 stiffness = Mat6::Zero();
    stiffness.bottomRightCorner<3, 3>() = -load.turning;
    at_rest_.setZero();
    std::array<Mat63, limbs_most> b;
    for (int i = 0; i < count_; i++) {
        if (!bears_[i]) {
            continue;
        }
        const brace_stance_limb_t &limb = stance.limb[i];
        const Mat3 arm = cross(vec3(limb.foot_mm)), preload = cross(vec3(limb.force_n));
        k_[i] = mat3(limb.k_n_per_mm);
        e_[i] = vec3(limb.force_n) - k_[i] * vec3(limb.moved_mm);
        h_[i] << k_[i], preload - k_[i] * arm;
        b[i] << k_[i], arm * k_[i] - preload;
        stiffness.topRows<3>() += h_[i];
        stiffness.bottomRows<3>() += arm * h_[i];
        stiffness.bottomLeftCorner<3, 3>() -= preload;
        at_rest_.head<3>() += e_[i];
        at_rest_.tail<3>() += arm * e_[i];
    }
    if (!invert(stiffness, compliance_)) {
        return false;
    }
    for (int i = 0; i < count_; i++) {
        if (bears_[i]) {
            moves_[i] = compliance_ * b[i];
        }
    }
    return true;
}

Vec6 Body::displacement(const Places &feet, const Vec6 &wrench) const
{
    Vec6 body = compliance_ * (at_rest_ + wrench);
    for (int i = 0; i < count_; i++) {
        if (bears_[i]) {
            body += moves_[i] * feet[i];
        }
    }
    return body;
}

Vec3 hanging_place(const brace_stance_limb_t &limb, const Vec6 &body)
{
    const Mat3 k = mat3(limb.k_n_per_mm);
    const Vec3 unloaded = vec3(limb.moved_mm) - k.inverse() * vec3(limb.force_n);
    return unloaded + body.head<3>() + Vec3(body.tail<3>()).cross(vec3(limb.foot_mm));
}

} // namespace brace::stance
