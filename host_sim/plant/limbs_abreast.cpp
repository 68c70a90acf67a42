#include "plant/limbs_abreast.h"

#include <cassert>

namespace brace::plant {
namespace {

template <class One, class Four> void put(std::size_t lane, const One &from, Four &to)
{
    for (Eigen::Index i = 0; i < from.size(); ++i) {
        to(i).at[lane] = from(i);
    }
}

template <class Four, class One> void copy(std::size_t lane, const Four &from, One &to)
{
    for (Eigen::Index i = 0; i < from.size(); ++i) {
        to(i) = from(i).at[lane];
    }
}

Tangent<2> take(std::size_t lane, const TangentOf<Lanes, 2> &from)
{
    Tangent<2> to;
    copy(lane, from.tip_mm, to.tip_mm);
    copy(lane, from.compliance_mm_per_n, to.compliance_mm_per_n);
    copy(lane, from.torque_n_mm_per_rad, to.torque_n_mm_per_rad);
    for (std::size_t k = 0; k < 2; ++k) {
        to.torque_n_mm[k] = from.torque_n_mm[k].at[lane];
        copy(lane, from.lever_mm[k], to.lever_mm[k]);
    }
    to.negative_pivots = from.negative_pivots.at[lane];
    return to;
}

Condensed::Followed take(std::size_t lane, std::size_t bodies, const CondensedOf<Lanes>::Followed &from)
{
    Condensed::Followed to;
    for (std::size_t i = 0; i < bodies; ++i) {
        to.shape.turn_rad[i] = from.shape.turn_rad[i].at[lane];
    }
    copy(lane, from.shape.force_n, to.shape.force_n);
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
    // Lanes without a run are worked out as well.
    for (BodyOf<Lanes> &body : structure_.body) {
        body.extent_mm.setZero();
        body.weight_arm_mm.setZero();
        body.deviation_mm_per_n.setZero();
    }
    structure_.base_mm_per_n.setZero();
    structure_.down.setZero();
    structure_.joint_load_n_mm.setZero();
}

// All are one limb, so that they have the same bodies, which yield at the same places. Only postures differ, and what a
// change of a link has come to.
void LimbsAbreast::put_in_structure(std::size_t lane)
{
    const Structure &from = limb_[lane].structure();
    assert(structure_.body_count == 0 || structure_.body_count == from.body_count);
    structure_.body_count = from.body_count;
    for (std::size_t i = 0; i < static_cast<std::size_t>(from.body_count); ++i) {
        const Body &body = from.body[i];
        BodyOf<Lanes> &to = structure_.body[i];
        to.joint = body.joint;
        to.yields = body.yields;
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
            const Change<2> one = limb_[lane].take_change(take(lane, condensed_.tangent()));
            put(lane, one.force_n, change.force_n);
            for (std::size_t k = 0; k < 2; ++k) {
                change.turn_rad[k].at[lane] = one.turn_rad[k];
            }
        }
    }
    CondensedOf<Lanes>::Followed followed;
    condensed_.follow(change, shape_, followed);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (limb_[lane].seeks()) {
            limb_[lane].went_to(take(lane, static_cast<std::size_t>(structure_.body_count), followed));
        }
    }
}

} // namespace brace::plant
