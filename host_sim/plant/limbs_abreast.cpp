#include "plant/limbs_abreast.h"

namespace brace::plant {
namespace {

static_assert(kLanes == 4, "a limb for each lane");

template <int Rows, int Columns>
void put(std::size_t lane, const Eigen::Matrix<double, Rows, Columns> &from, Eigen::Matrix<Lanes, Rows, Columns> &to)
{
    for (Eigen::Index i = 0; i < from.size(); ++i) {
        to(i).at[lane] = from(i);
    }
}

template <int Rows, int Columns>
void take(std::size_t lane, const Eigen::Matrix<Lanes, Rows, Columns> &from, Eigen::Matrix<double, Rows, Columns> &to)
{
    for (Eigen::Index i = 0; i < from.size(); ++i) {
        to(i) = from(i).at[lane];
    }
}

Tangent<2> take(std::size_t lane, const TangentOf<Lanes, 2> &from)
{
    Tangent<2> to;
    take(lane, from.tip_mm, to.tip_mm);
    take(lane, from.compliance_mm_per_n, to.compliance_mm_per_n);
    take(lane, from.torque_n_mm_per_rad, to.torque_n_mm_per_rad);
    for (std::size_t k = 0; k < 2; ++k) {
        to.torque_n_mm[k] = from.torque_n_mm[k].at[lane];
        take(lane, from.lever_mm[k], to.lever_mm[k]);
    }
    to.negative_pivots = from.negative_pivots.at[lane];
    return to;
}

InPlane::Followed take(std::size_t lane, std::size_t bodies, const FollowedOf<Lanes, 2, kMostBodies> &from)
{
    InPlane::Followed to;
    for (std::size_t i = 0; i < bodies; ++i) {
        to.shape.turn_rad[i] = from.shape.turn_rad[i].at[lane];
    }
    take(lane, from.shape.force_n, to.shape.force_n);
    for (std::size_t k = 0; k < 2; ++k) {
        to.torque_n_mm[k] = from.torque_n_mm[k].at[lane];
    }
    to.most_rad = from.most_rad.at[lane];
    return to;
}

} // namespace

LimbsAbreast::LimbsAbreast(const Model &model)
    : limb_{LimbState<InPlane>(model, Displacements::finite), LimbState<InPlane>(model, Displacements::finite),
            LimbState<InPlane>(model, Displacements::finite), LimbState<InPlane>(model, Displacements::finite)}
{
}

// The lanes' limbs have the same bodies. Where a body yields, or has weight, in one lane only, it does so by nothing in
// the others.
void LimbsAbreast::put_in_structure(std::size_t lane)
{
    const Structure &from = limb_[lane].structure();
    structure_.body_count = from.body_count;
    structure_.joint_body = from.joint_body;
    for (std::size_t i = 0; i < static_cast<std::size_t>(from.body_count); ++i) {
        const Body &body = from.body[i];
        BodyOf<Lanes> &to = structure_.body[i];
        to.joint = body.joint;
        to.yields = body.yields != Yields::nowhere ? body.yields : to.yields;
        to.hinge_rad_per_n_mm.at[lane] = body.hinge_rad_per_n_mm;
        to.weight_n.at[lane] = body.weight_n;
        to.end_weight_n.at[lane] = body.end_weight_n;
        to.mean_mm_per_n.at[lane] = body.mean_mm_per_n;
        put(lane, body.extent_mm, to.extent_mm);
        put(lane, body.weight_arm_mm, to.weight_arm_mm);
        put(lane, body.deviation_mm_per_n, to.deviation_mm_per_n);
    }
    put(lane, from.base_mm_per_n, structure_.base_mm_per_n);
    put(lane, from.down, structure_.down);
    put(lane, from.joint_load_n_mm, structure_.joint_load_n_mm);
    structure_.reach_mm.at[lane] = from.reach_mm;
}

void LimbsAbreast::put_in(std::size_t lane)
{
    const LimbState<InPlane> &limb = limb_[lane];
    if (structure_seen_[lane] != limb.structures_found()) {
        structure_seen_[lane] = limb.structures_found();
        put_in_structure(lane);
    }
    const std::array<JointHinge, 2> joint = limb.joint_hinges();
    for (std::size_t k = 0; k < 2; ++k) {
        joint_[k].compliance_rad_per_n_mm.at[lane] = joint[k].compliance_rad_per_n_mm;
        joint_[k].unstrained_rad.at[lane] = joint[k].unstrained_rad;
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(structure_.body_count); ++i) {
        shape_.turn_rad[i].at[lane] = limb.shape().turn_rad[i];
    }
    put(lane, limb.shape().force_n, shape_.force_n);
}

void LimbsAbreast::step()
{
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (limb_[lane].seeks()) {
            put_in(lane);
        }
    }
    condensed_.about(structure_, joint_, shape_);
    ChangeOf<Lanes, 2> change;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (limb_[lane].seeks()) {
            const Change<2> one = limb_[lane].change_under(take(lane, condensed_.tangent()));
            put(lane, one.force_n, change.force_n);
            for (std::size_t k = 0; k < 2; ++k) {
                change.turn_rad[k].at[lane] = one.turn_rad[k];
            }
        }
    }
    FollowedOf<Lanes, 2, kMostBodies> followed;
    condensed_.follow(change, followed);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (limb_[lane].seeks()) {
            limb_[lane].went_to(take(lane, static_cast<std::size_t>(structure_.body_count), followed));
        }
    }
}

} // namespace brace::plant
