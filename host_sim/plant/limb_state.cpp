#include "plant/limb_state.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "effects/contact_play.h"
#include "effects/creep.h"
#include "effects/link_change.h"

namespace brace::plant {
namespace {

// A rigid joint with backlash gets this share of the limb's compliance, so that its stop is a spring.
constexpr double kStopCompliance = 1e-8;
// When a structure is rigid in one direction while its joints stick, it gets this share of the limb's compliance.
constexpr double kRigidCompliance = 1e-9;
constexpr double kSmallestShare = 1e-12; // the same for a tangent that is only read

template <int N>
constexpr int kAllFree = (1 << N) - 1;
constexpr int kMostSteps = 12;
constexpr double kGoodMove_n = 1e-10;     // a step that moves less is the last
constexpr double kPromisedMove_n = 1e-9;  // what a step may move where rounding keeps it from becoming less
constexpr double kRounding = 1e-14; // relative, of places
constexpr double kLost_n = std::numeric_limits<double>::infinity();
constexpr double kMostTurn_rad = 0.25; // in one step; a larger one may end at another rest state than the nearest
constexpr double kMostForeseen = 1.0; // of the way since an earlier place
constexpr double kStraight = 1e-9;
constexpr double kShortestPart = 1.0 / 64.0; // of the way to a displacement

// The sum of the products of two eigenvalues each.
double pairs(const Eigen::Matrix3d &matrix)
{
    return matrix.topLeftCorner<2, 2>().determinant() + matrix.bottomRightCorner<2, 2>().determinant()
           + matrix(0, 0) * matrix(2, 2) - matrix(0, 2) * matrix(2, 0);
}

// The smallest eigenvalue of a compliance over the largest, but for a small factor.
double least_share(const Eigen::Matrix2d &compliance)
{
    const double trace = compliance.trace();
    return trace > 0.0 ? compliance.determinant() / (trace * trace) : 0.0;
}

double least_share(const Eigen::Matrix3d &compliance)
{
    const double scale = compliance.trace() * pairs(compliance);
    return scale > 0.0 ? compliance.determinant() / scale : 0.0;
}

// K where the tip is held along all axes, or in the plane along one with no force along the other, or is free.
template <int N>
Matrix<N> stiffness_held(const Matrix<N> &compliance, int free_axis)
{
    if (free_axis == 0) {
        return compliance.inverse();
    }
    Matrix<N> stiffness = Matrix<N>::Zero();
    if (free_axis != kAllFree<N>) {
        const int held = 2 - free_axis;
        stiffness(held, held) = 1.0 / compliance(held, held);
    }
    return stiffness;
}

int negative_eigenvalues(const Eigen::Matrix2d &compliance)
{
    if (compliance.determinant() < 0.0) {
        return 1;
    }
    return compliance.trace() < 0.0 ? 2 : 0;
}

// All eigenvalues are real, so the signs of their characteristic polynomial tell (Descartes).
int negative_eigenvalues(const Eigen::Matrix3d &compliance)
{
    int changes = 0;
    double last = 1.0;
    for (const double each : {compliance.trace(), pairs(compliance), compliance.determinant()}) {
        changes += last * each < 0.0 ? 1 : 0;
        last = each;
    }
    return changes;
}

// How many of a compliance's directions, among those held, push the wrong way.
template <int N>
int negatives(const Matrix<N> &compliance, int free_axis)
{
    if (free_axis == kAllFree<N>) {
        return 0;
    }
    if (free_axis != 0) {
        return compliance(2 - free_axis, 2 - free_axis) < 0.0 ? 1 : 0;
    }
    return negative_eigenvalues(compliance);
}

void find(const Model &model, Displacements displacements, double theta1_rad, double theta2_rad, double t_s,
          Structure &structure)
{
    find_structure(model, displacements, theta1_rad, theta2_rad, t_s, structure);
}

void find(const Model &model, Displacements, double theta1_rad, double theta2_rad, double t_s,
          SpaceStructure &structure)
{
    find_structure(model, theta1_rad, theta2_rad, t_s, structure);
}

} // namespace

template <class World>
bool LimbState<World>::move_to(double theta1_rad, double theta2_rad, double t_s, double temp_degc)
{
    using effects::link_change::has_come;
    const bool same_structure = placed_ && theta1_rad == theta1_rad_ && theta2_rad == theta2_rad_
                                && has_come(model_, t_s) == has_come(model_, t_s_);
    const bool same_joints =
        placed_ && (temp_degc == temp_degc_ || model_.thermal.joint_compliance_per_degc == 0.0);
    if (placed_) {
        let_creep(t_s);
    }
    theta1_rad_ = theta1_rad;
    theta2_rad_ = theta2_rad;
    t_s_ = t_s;
    temp_degc_ = temp_degc;
    placed_ = true;
    if (!same_structure) {
        find(model_, displacements_, theta1_rad, theta2_rad, t_s, structure_);
        find_unloaded();
        weight_n_ = total_weight_n(structure_) * structure_.down;
        ++structures_found_;
        has_earlier_ = false;
    }
    if (!(prepared_ && same_structure && same_joints)) {
        prepared_ = prepare();
    }
    return prepared_;
}

// Without load no hinge's turn changes what the others do: a joint's spring adds its lever's square to the compliance.
template <class World>
void LimbState<World>::find_unloaded()
{
    typename World::Condensed unloaded;
    unloaded.about(without_loads(structure_), std::array<JointHinge, N>{}, typename World::Condensed::Shape{});
    joints_rigid_mm_per_n_ = unloaded.tangent().compliance_mm_per_n;
    unloaded_lever_mm_ = unloaded.tangent().lever_mm;
}

// A joint that is more than a spring is an unknown, unless it is rigid and without backlash.
template <class World>
bool LimbState<World>::prepare()
{
    is_condensed_ = false;
    known_count_ = 0;
    const Mat contact = contact_mm_per_n_ * Mat::Identity();
    Mat own = joints_rigid_mm_per_n_;
    Mat stuck = own + contact; // while no unknown turns
    for (std::size_t k = 0; k < N; ++k) {
        law_[k] = joint_law(model_, World::kFirstJoint + static_cast<int>(k), temp_degc_);
        const Vec &lever_mm = unloaded_lever_mm_[k];
        const Mat by_joint = law_[k].compliance_rad_per_n_mm * lever_mm * lever_mm.transpose();
        const bool can_turn = law_[k].compliance_rad_per_n_mm != 0.0 || law_[k].gap_rad != 0.0;
        is_unknown_[k] = can_turn && !is_linear(law_[k]);
        own += by_joint;
        if (!is_unknown_[k]) {
            stuck += by_joint;
        }
    }
    const Mat whole = own + contact;
    const double whole_mm_per_n = whole.trace();
    if (!(least_share(whole) > 1e-15)) {
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
    const bool is_rigid = has_unknowns() && !(least_share(stuck) > 1e-12);
    stops_mm_per_n_ = is_rigid ? kRigidCompliance * whole_mm_per_n : 0.0;
    return true;
}

template <class World>
void LimbState<World>::start_run(bool creep_gone, double contact_mm_per_n)
{
    prepared_ = prepared_ && contact_mm_per_n == contact_mm_per_n_;
    contact_mm_per_n_ = contact_mm_per_n;
    rest_ = {};
    known_count_ = 0;
    has_earlier_ = false;
    before_rad_ = {};
    origin_mm_ = reached_mm_ = tip_mm_ = Vec::Zero();
    if (creep_gone) {
        delayed_rad_ = {};
    }
}

template <class World>
void LimbState<World>::let_creep(double t_s)
{
    if (model_.creep.ratio == 0.0) {
        return;
    }
    const double dt = t_s - t_s_;
    if (dt != creep_dt_s_) {
        creep_dt_s_ = dt;
        creep_approach_ = effects::creep::approach(model_.creep.time_constant_s, dt);
    }
    for (std::size_t k = 0; k < N; ++k) {
        const double elastic = elastic_rad(law_[k], before_rad_[k]);
        delayed_rad_[k] =
            effects::creep::delayed_rad(delayed_rad_[k], model_.creep.ratio, elastic, creep_approach_);
    }
    is_condensed_ = false;
}

template <class World>
auto LimbState<World>::joint_hinges() const -> std::array<JointHinge, N>
{
    std::array<JointHinge, N> joint;
    for (std::size_t k = 0; k < N; ++k) {
        joint[k] = is_unknown_[k] ? JointHinge{0.0, turn_of(k)}
                                  : JointHinge{law_[k].compliance_rad_per_n_mm, delayed_rad_[k]};
    }
    return joint;
}

template <class World>
auto LimbState<World>::take_change(const Tangent<N> &tangent) -> Change<N>
{
    const Vec &force_n = rest_.shape.force_n;
    const double series_mm_per_n = contact_mm_per_n_ + stops_mm_per_n_;
    Mat compliance = tangent.compliance_mm_per_n;
    compliance.diagonal().array() += series_mm_per_n;
    const Mat stiffness = stiffness_held<N>(compliance, search_.free_axis);
    const Vec lacks_mm = search_.part_target_mm - tangent.tip_mm - series_mm_per_n * force_n;
    Change<N> change;
    bool solved = true;
    if (!has_unknowns()) {
        change.force_n = stiffness * lacks_mm;
    } else {
        // All unknowns are counted from nothing here, so that a joint that sticks keeps its bits.
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
        solved = state.solved;
        change.force_n = state.force_n - force_n;
        for (std::size_t i = 0; i < static_cast<std::size_t>(problem.joint_count); ++i) {
            const std::size_t k = joint_of[i];
            rest_.instant_rad[k] = state.deflection_rad[i];
            change.turn_rad[k] = state.deflection_rad[i] + delayed_rad_[k] - turn_of(k);
        }
    }
    rest_.tip_mm = tangent.tip_mm + tangent.compliance_mm_per_n * change.force_n;
    for (std::size_t k = 0; k < N; ++k) {
        rest_.tip_mm += change.turn_rad[k] * tangent.lever_mm[k];
    }
    search_.stable = solved && tangent.negative_pivots == negatives<N>(compliance, search_.free_axis);
    search_.change_n = change.force_n.norm();
    search_.rounding_n = kRounding * stiffness.norm() * (search_.part_target_mm.norm() + rest_.tip_mm.norm());
    return change;
}

template <class World>
void LimbState<World>::went_to(const typename World::Condensed::Followed &followed)
{
    rest_.shape = followed.shape;
    rest_.torque_n_mm = followed.torque_n_mm;
    for (std::size_t k = 0; k < N; ++k) {
        if (!is_unknown_[k]) {
            rest_.instant_rad[k] = turn_of(k) - delayed_rad_[k];
        }
    }
    const double moved_n = followed.most_rad <= kMostTurn_rad
                               ? std::max(search_.change_n, followed.most_rad * structure_.reach_mm / softest_mm_per_n_)
                               : kLost_n;
    const Outcome so = outcome(moved_n);
    if (so != Outcome::goes_on) {
        end_part(so == Outcome::settled);
    }
}

// Steps go on until the next one would move nothing.
template <class World>
auto LimbState<World>::outcome(double moved_n) -> Outcome
{
    const Outcome ended = search_.stable ? Outcome::settled : Outcome::lost;
    if (displacements_ == Displacements::small) {
        return ended;
    }
    const int step = search_.steps++;
    const double last_moved_n = search_.last_moved_n;
    search_.last_moved_n = moved_n;
    if (!(moved_n < kLost_n)) {
        return Outcome::lost;
    }
    // Each step squares what is left, so the next one moves less than in proportion.
    if (moved_n <= kGoodMove_n || (step > 0 && moved_n * moved_n <= kGoodMove_n * last_moved_n)) {
        return ended;
    }
    if (step > 2 && moved_n > 0.5 * last_moved_n) {
        return moved_n <= std::max(kPromisedMove_n, search_.rounding_n) ? ended : Outcome::lost;
    }
    return search_.steps < kMostSteps ? Outcome::goes_on : Outcome::lost;
}

// Goes on to where rest would be if the limb went on as it came. It saves a step of Newton's method. A joint that
// friction holds stays where it is. false: the tip does not go on along its way, or too far.
template <class World>
bool LimbState<World>::foresee(const Vec &target_mm)
{
    if (!has_earlier_) {
        return false;
    }
    const Vec way_mm = reached_mm_ - earlier_.target_mm;
    const Vec ahead_mm = target_mm - reached_mm_;
    const double part = ahead_mm.dot(way_mm) / way_mm.squaredNorm();
    if (!(std::fabs(part) <= kMostForeseen) || (ahead_mm - part * way_mm).norm() > kStraight * ahead_mm.norm()) {
        return false;
    }
    const Rest &earlier = earlier_.rest;
    for (std::size_t i = 0; i < static_cast<std::size_t>(structure_.body_count); ++i) {
        rest_.shape.turn_rad[i] += part * (rest_.shape.turn_rad[i] - earlier.shape.turn_rad[i]);
    }
    rest_.shape.force_n += part * (rest_.shape.force_n - earlier.shape.force_n);
    for (std::size_t k = 0; k < N; ++k) {
        rest_.instant_rad[k] += law_[k].rubs() ? 0.0 : part * (rest_.instant_rad[k] - earlier.instant_rad[k]);
    }
    return true;
}

// Begins to lead the tip to the target.
template <class World>
void LimbState<World>::begin_search(const Vec &target_mm, int free_axis)
{
    for (int axis = 0; axis < N; ++axis) {
        if ((free_axis >> axis & 1) != 0) {
            rest_.shape.force_n[axis] = 0.0;
        }
    }
    search_.target_mm = target_mm;
    search_.free_axis = free_axis;
    search_.reached_share = 0.0;
    search_.part_share = 1.0;
    search_.part_began = rest_;
    search_.foreseen = free_axis == 0 && foresee(target_mm);
    search_.seeks = true;
    begin_part();
}

template <class World>
void LimbState<World>::begin_part()
{
    search_.end_share = std::min(1.0, search_.reached_share + search_.part_share);
    search_.part_target_mm = search_.end_share == 1.0 ? search_.target_mm : on_the_way_mm(search_.end_share);
    search_.steps = 0;
    search_.last_moved_n = kLost_n;
    if (displacements_ == Displacements::small) {
        rest_.shape = {};
    }
}

// Where rest is not found, the next part begins where the last one ended, and is half as long.
template <class World>
void LimbState<World>::end_part(bool settled)
{
    if (settled && search_.end_share == 1.0) {
        end_search(search_.target_mm, true);
        return;
    }
    if (settled) {
        search_.part_began = rest_;
        search_.reached_share = search_.end_share;
    } else if (search_.foreseen) {
        rest_ = search_.part_began;
        search_.foreseen = false;
    } else if (displacements_ == Displacements::small) {
        end_search(search_.target_mm, false);
        return;
    } else {
        rest_ = search_.part_began;
        search_.part_share *= 0.5;
        if (search_.part_share < kShortestPart) {
            end_search(on_the_way_mm(search_.reached_share), false);
            return;
        }
    }
    begin_part();
}

template <class World>
auto LimbState<World>::on_the_way_mm(double share) const -> Vec
{
    return reached_mm_ + share * (search_.target_mm - reached_mm_);
}

template <class World>
void LimbState<World>::end_search(const Vec &reached_mm, bool solved)
{
    reached_mm_ = reached_mm;
    search_.solved = solved;
    search_.seeks = false;
}

// Steps alone to the end.
template <class World>
void LimbState<World>::seek()
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

template <class World>
bool LimbState<World>::hang()
{
    begin_search(reached_mm_, kAllFree<N>);
    seek();
    before_rad_ = rest_.instant_rad;
    origin_mm_ = rest_.tip_mm;
    return search_.solved;
}

template <class World>
bool LimbState<World>::has_unknowns() const
{
    return std::any_of(is_unknown_.begin(), is_unknown_.end(), [](bool is_unknown) { return is_unknown; });
}

template <class World>
bool LimbState<World>::forgets() const
{
    const bool rubs = std::any_of(law_.begin(), law_.end(), [](const JointLaw &law) { return law.rubs(); });
    return !rubs && model_.creep.ratio == 0.0;
}

template <class World>
auto LimbState<World>::known_at(const Vec &target_mm, int free_axis) const -> const Known *
{
    const auto end = known_.begin() + known_count_;
    const auto found = std::find_if(known_.begin(), end, [&](const Known &known) {
        return known.target_mm == target_mm && known.free_axis == free_axis;
    });
    return found != end ? &*found : nullptr;
}

template <class World>
auto LimbState<World>::hold_tip(const Vec &displacement_mm, int free_axis) -> LimbRest<N>
{
    begin_hold(displacement_mm, free_axis);
    seek();
    return end_hold();
}

template <class World>
void LimbState<World>::begin_hold(const Vec &displacement_mm, int free_axis)
{
    tip_mm_ = effects::contact_play::dragged_mm<N>(model_, tip_mm_, displacement_mm);
    const Vec target_mm = origin_mm_ + tip_mm_;
    const Known *known = forgets() ? known_at(target_mm, free_axis) : nullptr;
    is_new_ = known == nullptr;
    leads_on_ = false;
    if (known != nullptr) {
        rest_ = known->rest;
        end_search(target_mm, true);
        return;
    }
    begin_search(target_mm, free_axis);
    const bool searched = displacements_ == Displacements::finite || has_unknowns();
    leads_on_ = searched && free_axis == 0 && target_mm != reached_mm_;
    if (leads_on_) {
        earlier_ = {reached_mm_, free_axis, search_.part_began};
    }
}

template <class World>
auto LimbState<World>::end_hold() -> LimbRest<N>
{
    const bool solved = search_.solved;
    if (leads_on_) {
        has_earlier_ = solved;
    }
    if (is_new_ && solved && forgets() && known_count_ < kMostKnown) {
        known_[static_cast<std::size_t>(known_count_++)] = {search_.target_mm, search_.free_axis, rest_};
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

template <class World>
auto LimbState<World>::torque_per_motor_turn() const -> Mat
{
    std::array<JointHinge, N> joint{};
    for (std::size_t k = 0; k < N; ++k) {
        joint[k].compliance_rad_per_n_mm = law_[k].compliance_rad_per_n_mm;
    }
    const bool small = displacements_ == Displacements::small;
    typename World::Condensed springs;
    springs.about(structure_, joint, small ? typename World::Condensed::Shape{} : rest_.shape);
    const Tangent<N> &tangent = springs.tangent();
    Mat compliance = tangent.compliance_mm_per_n;
    compliance.diagonal().array() += contact_mm_per_n_ + kSmallestShare * compliance.trace();
    Mat lever;
    for (std::size_t k = 0; k < N; ++k) {
        lever.col(static_cast<Eigen::Index>(k)) = tangent.lever_mm[k];
    }
    return tangent.torque_n_mm_per_rad - lever.transpose() * compliance.inverse() * lever;
}

template class LimbState<InPlane>;
template class LimbState<InSpace>;

} // namespace brace::plant
