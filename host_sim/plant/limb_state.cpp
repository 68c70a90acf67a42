#include "plant/limb_state.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "effects/contact_play.h"
#include "effects/creep.h"
#include "effects/gravity.h"
#include "effects/memory.h"
#include "plant/held.h"

namespace brace::plant {
namespace {

// Springs that stand for what is rigid, as shares of the limb's compliance.
constexpr double kStopCompliance = 1e-8;   // a rigid joint's stop behind its backlash
constexpr double kRigidCompliance = 1e-9;  // a structure that is rigid in one direction while its joints stick
constexpr double kSmallestShare = 1e-12;   // the same for a tangent that is only read
// Shares of the smallest eigenvalue in the largest.
constexpr double kStuckShare = 0.1; // of a spring's compliance that is left where friction holds the joint
constexpr double kNothingYields = 1e-15; // in some direction
constexpr double kIsRigid = 1e-12;       // in some direction, while joints stick

constexpr double kRounding = 1e-14;    // relative, of places
constexpr double kMostTurn_rad = 0.25; // in one step; a larger one may end at another rest state than the nearest
constexpr double kMostForeseen = 1.0;  // of the way since an earlier place
constexpr double kStraight = 1e-9;     // what a way may leave the line of the last one, of its length

void find(const Model &now, Displacements displacements, double theta1_rad, double theta2_rad, Structure &structure)
{
    find_structure(now, displacements, theta1_rad, theta2_rad, structure);
}

void find(const Model &now, Displacements, double theta1_rad, double theta2_rad, SpaceStructure &structure)
{
    find_structure(now, theta1_rad, theta2_rad, structure);
}

} // namespace

template <class World>
bool LimbState<World>::move_to(double theta1_rad, double theta2_rad, const effects::Conditions &conditions)
{
    bool same_limb = placed_, same_structure = placed_ && theta1_rad == theta1_rad_ && theta2_rad == theta2_rad_;
    Model now;
    const bool leans = placed_ && !effects::gravity::is_same(model_, now_); // its base was turned
    if (!placed_ || leans || is_changed_ || effects::Changes::act(model_)) {
        now = effects::limb_now(model_, conditions);
        same_limb = placed_ && effects::is_same(now, now_);
        same_structure = same_structure && !leans && (same_limb || effects::is_same_but_for_springs(now, now_));
    }
    if (placed_ && effects::creep::acts(now_)) {
        let_creep(conditions.t_s - t_s_);
    }
    theta1_rad_ = theta1_rad;
    theta2_rad_ = theta2_rad;
    t_s_ = conditions.t_s;
    placed_ = true;
    is_changed_ = false;
    if (!same_limb) {
        now_ = now;
    }
    if (!same_structure) {
        find(now_, displacements_, theta1_rad, theta2_rad, structure_);
        find_unloaded();
        weight_n_ = total_weight_n(structure_) * structure_.down;
        ++structures_found_;
        has_earlier_ = false;
    }
    if (!(prepared_ && same_structure && same_limb)) {
        prepared_ = prepare();
    }
    return prepared_;
}

// Without load no hinge's turn changes what the others do: a joint's spring adds its lever's square to the compliance.
template <class World> void LimbState<World>::find_unloaded()
{
    typename World::Condensed unloaded;
    unloaded.about(without_loads(structure_), std::array<JointHinge, N>{}, typename World::Condensed::Shape{});
    joints_rigid_mm_per_n_ = unloaded.tangent().compliance_mm_per_n;
    unloaded_lever_mm_ = unloaded.tangent().lever_mm;
}

// A joint that is more than a spring is an unknown, unless it is rigid and without backlash.
template <class World> bool LimbState<World>::prepare()
{
    is_condensed_ = false;
    known_.clear();
    const Mat contact = contact_mm_per_n_ * Mat::Identity();
    Mat own = joints_rigid_mm_per_n_;
    Mat stuck = own + contact; // while no unknown turns
    for (std::size_t k = 0; k < N; ++k) {
        law_[k] = now_.joint[World::kFirstJoint + static_cast<int>(k)];
        const Vec &lever_mm = unloaded_lever_mm_[k];
        const Mat by_joint = law_[k].compliance_rad_per_n_mm * lever_mm * lever_mm.transpose();
        is_unknown_[k] = can_turn(law_[k]) && !is_linear(law_[k]);
        own += by_joint;
        if (!is_unknown_[k]) {
            stuck += by_joint;
        }
    }
    const Mat whole = own + contact;
    const double whole_mm_per_n = whole.trace();
    if (!(least_share(whole) > kNothingYields)) {
        return false;
    }
    for (std::size_t k = 0; k < N; ++k) {
        if (is_unknown_[k] && law_[k].compliance_rad_per_n_mm == 0.0) {
            law_[k].compliance_rad_per_n_mm =
                kStopCompliance * whole_mm_per_n / std::max(unloaded_lever_mm_[k].squaredNorm(), 1.0);
        }
    }
    const double own_mm_per_n = own.trace();
    softest_mm_per_n_ = own_mm_per_n > 0.0 ? own_mm_per_n : whole_mm_per_n;
    const bool is_rigid = has_unknowns() && !(least_share(stuck) > kIsRigid);
    stops_mm_per_n_ = is_rigid ? kRigidCompliance * whole_mm_per_n : 0.0;
    return true;
}

template <class World> void LimbState<World>::start_run(bool creep_gone, double contact_mm_per_n)
{
    prepared_ = prepared_ && contact_mm_per_n == contact_mm_per_n_;
    contact_mm_per_n_ = contact_mm_per_n;
    rest_ = {};
    known_.clear();
    has_earlier_ = false;
    before_rad_ = {};
    origin_mm_ = tip_mm_ = Vec::Zero();
    search_.end_at(Vec::Zero(), true);
    if (creep_gone) {
        delayed_rad_ = {};
    }
}

template <class World> void LimbState<World>::let_creep(double dt_s)
{
    if (dt_s != creep_dt_s_) {
        creep_dt_s_ = dt_s;
        creep_approach_ = effects::creep::approach(now_, dt_s);
    }
    for (std::size_t k = 0; k < N; ++k) {
        const double elastic = elastic_rad(law_[k], before_rad_[k]);
        delayed_rad_[k] = effects::creep::delayed_rad(now_, delayed_rad_[k], elastic, creep_approach_);
    }
    is_condensed_ = false;
}

template <class World> auto LimbState<World>::joint_hinges() const -> std::array<JointHinge, N>
{
    std::array<JointHinge, N> joint;
    for (std::size_t k = 0; k < N; ++k) {
        joint[k] =
            is_unknown_[k] ? JointHinge{0.0, turn_of(k)} : JointHinge{law_[k].compliance_rad_per_n_mm, delayed_rad_[k]};
    }
    return joint;
}

template <class World> auto LimbState<World>::take_change(const Tangent<N> &tangent) -> Change<N>
{
    const double series_mm_per_n = contact_mm_per_n_ + stops_mm_per_n_;
    Mat compliance = tangent.compliance_mm_per_n;
    compliance.diagonal().array() += series_mm_per_n;
    const Mat stiffness = stiffness_held<N>(compliance, search_.free_axis());
    const Vec lacks_mm = search_.part_target_mm() - tangent.tip_mm - series_mm_per_n * rest_.shape.force_n;
    Change<N> change;
    bool solved = true;
    if (has_unknowns()) {
        solved = balance_joints(tangent, compliance, stiffness, lacks_mm, change);
    } else {
        change.force_n = stiffness * lacks_mm;
    }
    rest_.tip_mm = tangent.tip_mm + tangent.compliance_mm_per_n * change.force_n;
    for (std::size_t k = 0; k < N; ++k) {
        rest_.tip_mm += change.turn_rad[k] * tangent.lever_mm[k];
    }
    step_.moved_n = change.force_n.norm();
    step_.rounding_n = kRounding * stiffness.norm() * (search_.part_target_mm().norm() + rest_.tip_mm.norm());
    step_.stable = solved && tangent.negative_pivots == negatives<N>(compliance, search_.free_axis());
    return change;
}

// The joints that are more than springs come to rest. All unknowns are counted from nothing here, so that a joint that
// sticks keeps its bits. false: they find no rest.
template <class World>
bool LimbState<World>::balance_joints(const Tangent<N> &tangent, const Mat &compliance, const Mat &stiffness,
                                      const Vec &lacks_mm, Change<N> &change)
{
    const Vec &force_n = rest_.shape.force_n;
    RestProblem<N> problem;
    RestState<N> state;
    std::array<std::size_t, N> joint_of{};
    problem.stiffness_n_per_mm = stiffness;
    problem.displacement_mm = lacks_mm + compliance * force_n;
    problem.joint_count = 0;
    for (std::size_t k = 0; k < N; ++k) {
        if (!is_unknown_[k]) {
            continue;
        }
        const auto i = static_cast<std::size_t>(problem.joint_count++);
        joint_of[i] = k;
        JointUnknown<N> &unknown = problem.joint[i];
        unknown.lever_mm = tangent.lever_mm[k];
        unknown.law = law_[k];
        unknown.before_rad = before_rad_[k];
        unknown.load_n_mm = tangent.torque_n_mm[k] - unknown.lever_mm.dot(force_n);
        state.deflection_rad[i] = rest_.instant_rad[k];
        problem.displacement_mm += (turn_of(k) - delayed_rad_[k]) * unknown.lever_mm;
    }
    for (int i = 0; i < problem.joint_count; ++i) {
        for (int j = 0; j < problem.joint_count; ++j) {
            const std::size_t a = joint_of[static_cast<std::size_t>(i)];
            const std::size_t b = joint_of[static_cast<std::size_t>(j)];
            const double by_turn =
                tangent.torque_n_mm_per_rad(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
            problem.by_loads_n_mm_per_rad(i, j) = -by_turn;
            problem.joint[static_cast<std::size_t>(i)].load_n_mm -= by_turn * (turn_of(b) - delayed_rad_[b]);
        }
    }
    find_rest(problem, state);
    change.force_n = state.force_n - force_n;
    for (std::size_t i = 0; i < static_cast<std::size_t>(problem.joint_count); ++i) {
        const std::size_t k = joint_of[i];
        rest_.instant_rad[k] = state.deflection_rad[i];
        change.turn_rad[k] = state.deflection_rad[i] + delayed_rad_[k] - turn_of(k);
    }
    return state.solved;
}

template <class World> void LimbState<World>::went_to(const typename World::Condensed::Followed &followed)
{
    rest_.shape = followed.shape;
    rest_.torque_n_mm = followed.torque_n_mm;
    for (std::size_t k = 0; k < N; ++k) {
        if (!is_unknown_[k]) {
            rest_.instant_rad[k] = turn_of(k) - delayed_rad_[k];
        }
    }
    const double turned_n = followed.most_rad * structure_.reach_mm / softest_mm_per_n_;
    step_.moved_n = followed.most_rad <= kMostTurn_rad ? std::max(step_.moved_n, turned_n) : search_.kLost_n;
    search_.stepped(step_, rest_);
    begin_linear();
}

// Small displacements count from the unloaded limb, wherever it was.
template <class World> void LimbState<World>::begin_linear()
{
    if (displacements_ == Displacements::small && search_.seeks()) {
        rest_.shape = {};
    }
}

// Goes on to where rest would be if the limb went on as it came. It saves a step of Newton's method. A joint that
// friction holds stays where it is. false: the tip does not go on along its way, or too far.
template <class World> bool LimbState<World>::foresee(const Vec &target_mm)
{
    if (!has_earlier_) {
        return false;
    }
    const Vec way_mm = search_.reached_mm() - earlier_mm_;
    const Vec ahead_mm = target_mm - search_.reached_mm();
    const double part = ahead_mm.dot(way_mm) / way_mm.squaredNorm();
    if (!(std::fabs(part) <= kMostForeseen) || (ahead_mm - part * way_mm).norm() > kStraight * ahead_mm.norm()) {
        return false;
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(structure_.body_count); ++i) {
        rest_.shape.turn_rad[i] += part * (rest_.shape.turn_rad[i] - earlier_.shape.turn_rad[i]);
    }
    rest_.shape.force_n += part * (rest_.shape.force_n - earlier_.shape.force_n);
    for (std::size_t k = 0; k < N; ++k) {
        rest_.instant_rad[k] += rubs(law_[k]) ? 0.0 : part * (rest_.instant_rad[k] - earlier_.instant_rad[k]);
    }
    return true;
}

// Begins to lead the tip to the target.
template <class World> void LimbState<World>::begin_search(const Vec &target_mm, int free_axis)
{
    for (int axis = 0; axis < N; ++axis) {
        if ((free_axis >> axis & 1) != 0) {
            rest_.shape.force_n[axis] = 0.0;
        }
    }
    search_.begin(target_mm, free_axis, rest_);
    if (free_axis == 0 && foresee(target_mm)) {
        search_.begins_foreseen();
    }
    begin_linear();
}

// Steps alone to the end.
template <class World> void LimbState<World>::seek()
{
    while (seeks()) {
        if (!is_condensed_) {
            condensed_.about(structure_, joint_hinges(), rest_.shape);
            is_condensed_ = displacements_ == Displacements::small;
        }
        typename World::Condensed::Followed followed;
        condensed_.follow(take_change(condensed_.tangent()), rest_.shape, followed);
        went_to(followed);
    }
}

template <class World> bool LimbState<World>::hang()
{
    begin_search(search_.reached_mm(), kAllFree<N>);
    seek();
    before_rad_ = rest_.instant_rad;
    origin_mm_ = rest_.tip_mm;
    return search_.solved();
}

template <class World> bool LimbState<World>::has_unknowns() const
{
    return std::any_of(is_unknown_.begin(), is_unknown_.end(), [](bool is_unknown) { return is_unknown; });
}

template <class World> bool LimbState<World>::remembers() const
{
    return effects::remembers_readings(now_, World::kFirstJoint);
}

template <class World> auto LimbState<World>::hold_tip(const Vec &displacement_mm, int free_axis) -> LimbRest<N>
{
    begin_hold(displacement_mm, free_axis);
    seek();
    return end_hold();
}

template <class World> void LimbState<World>::begin_hold(const Vec &displacement_mm, int free_axis)
{
    tip_mm_ = effects::contact_play::dragged_mm<N>(model_, tip_mm_, displacement_mm);
    const Vec target_mm = origin_mm_ + tip_mm_;
    const Rest *known = remembers() ? nullptr : known_.at(target_mm, free_axis);
    is_new_ = known == nullptr;
    leads_on_ = false;
    if (known != nullptr) {
        rest_ = *known;
        search_.end_at(target_mm, true);
        return;
    }
    begin_search(target_mm, free_axis);
    const bool searched = displacements_ == Displacements::finite || has_unknowns();
    leads_on_ = searched && free_axis == 0 && target_mm != search_.reached_mm();
    if (leads_on_) {
        earlier_mm_ = search_.reached_mm();
        earlier_ = search_.began();
    }
}

template <class World> auto LimbState<World>::end_hold() -> LimbRest<N>
{
    const bool solved = search_.solved();
    if (leads_on_) {
        has_earlier_ = solved;
    }
    if (is_new_ && solved && !remembers()) {
        known_.add(search_.target_mm(), search_.free_axis(), rest_);
    }
    for (std::size_t k = 0; k < N; ++k) {
        is_stuck_[k] = rubs(law_[k]) && rest_.instant_rad[k] == before_rad_[k];
    }
    before_rad_ = rest_.instant_rad;
    const Vec carried_n = rest_.shape.force_n + weight_n_;
    LimbRest<N> rest{rest_.shape.force_n, rest_.instant_rad, rest_.torque_n_mm,
                     structure_.base_mm_per_n.cwiseProduct(carried_n), solved};
    for (std::size_t k = 0; k < N; ++k) {
        rest.joint_deflection_rad[k] += delayed_rad_[k];
    }
    return rest;
}

template <class World> auto LimbState<World>::held() const -> LimbHeld<N>
{
    std::array<JointHinge, N> joint{};
    for (std::size_t k = 0; k < N; ++k) { // its spring bears what the joint bears
        const double compliance = law_[k].compliance_rad_per_n_mm;
        joint[k] = {compliance, turn_of(k) - compliance * rest_.torque_n_mm[k]};
    }
    const typename World::Condensed::Shape unbent{};
    const auto &shape = displacements_ == Displacements::small ? unbent : rest_.shape;
    typename World::Condensed springs;
    springs.about(structure_, joint, shape);
    const Tangent<N> &tangent = springs.tangent();
    const auto in_series = [&](Mat mm_per_n) {
        mm_per_n.diagonal().array() += contact_mm_per_n_ + kSmallestShare * mm_per_n.trace();
        return mm_per_n;
    };
    Mat lever;
    for (std::size_t k = 0; k < N; ++k) {
        lever.col(static_cast<Eigen::Index>(k)) = tangent.lever_mm[k];
    }
    LimbHeld<N> held;
    held.stiffness_n_per_mm = in_series(tangent.compliance_mm_per_n).inverse();
    held.torque_n_mm_per_rad = tangent.torque_n_mm_per_rad - lever.transpose() * held.stiffness_n_per_mm * lever;
    held.carried_n = rest_.shape.force_n + weight_n_;
    held.carried_n_mm = Vec::Zero();
    if constexpr (N == 3) {
        const Vec root_mm = structure_.root_mm + structure_.base_mm_per_n.cwiseProduct(held.carried_n);
        held.carried_n_mm = springs.moment_n_mm() + root_mm.cross(held.carried_n);
    }
    if (std::any_of(is_stuck_.begin(), is_stuck_.end(), [](bool is_stuck) { return is_stuck; })) {
        for (std::size_t k = 0; k < N; ++k) { // seen from the tip, a joint that friction holds hardly yields
            joint[k].compliance_rad_per_n_mm *= is_stuck_[k] ? kStuckShare : 1.0;
        }
        springs.about(structure_, joint, shape);
        held.stiffness_n_per_mm = in_series(springs.tangent().compliance_mm_per_n).inverse();
    }
    return held;
}

template class LimbState<InPlane>;
template class LimbState<InSpace>;

} // namespace brace::plant
