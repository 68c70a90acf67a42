#include "brace/stance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact.h"

using namespace brace::stance;

namespace {

constexpr double force_most_n = 1e6, place_most_mm = 1e5, stiffness_most_n_per_mm = 1e6;
constexpr double whole_way = 1.0 - 1e-9; // a last step below this would be rounding, and nothing slides in it
constexpr int halvings_most = 12; // of a step without rest: the share that is borne is known to 1/4096 of it

bool is_within(const double *values, int count, double most)
{
    return std::all_of(values, values + count, [most](double value) { return std::fabs(value) <= most; });
}

bool is_limb(const brace_stance_limb_t &limb)
{
    return is_within(limb.foot_mm, 3, place_most_mm) && is_within(limb.k_n_per_mm, 9, stiffness_most_n_per_mm) &&
           is_within(limb.force_n, 3, force_most_n) && is_within(limb.moved_mm, 3, place_most_mm) &&
           is_within(limb.normal, 3, 1.0 + 1e-6) && std::fabs(vec3(limb.normal).norm() - 1.0) <= 1e-6 &&
           limb.friction_ratio >= 0.0 && limb.friction_ratio <= 10.0 && limb.grip_n >= 0.0 &&
           limb.grip_n <= force_most_n;
}

bool is_stance(const brace_stance_t &stance)
{
    return stance.limb_count >= 1 && stance.limb_count <= BRACE_STANCE_LIMBS &&
           std::all_of(stance.limb, stance.limb + stance.limb_count, is_limb);
}

bool is_load(const brace_stance_load_t &load)
{
    return is_within(load.force_n, 3, force_most_n) && is_within(load.moment_n_mm, 3, force_most_n * place_most_mm) &&
           is_within(load.turning_n_mm, 9, force_most_n * place_most_mm);
}

void copy(const Vec3 &from, double *to)
{
    std::copy_n(from.data(), 3, to);
}

// a + share b, as the loads are: a straight line.
brace_stance_load_t along(const brace_stance_load_t &a, const brace_stance_load_t &b, double share)
{
    brace_stance_load_t sum;
    for (int i = 0; i < 3; i++) {
        sum.force_n[i] = a.force_n[i] + share * b.force_n[i];
        sum.moment_n_mm[i] = a.moment_n_mm[i] + share * b.moment_n_mm[i];
    }
    for (int i = 0; i < 9; i++) {
        sum.turning_n_mm[i] = a.turning_n_mm[i] + share * b.turning_n_mm[i];
    }
    return sum;
}

bool bears(const brace_stance_foot_t &foot)
{
    return foot.contact == BRACE_FOOT_STICKS || foot.contact == BRACE_FOOT_SLIDES;
}

std::array<bool, limbs_most> bearing(const brace_stance_t &stance, const brace_stance_state_t &state)
{
    std::array<bool, limbs_most> these{};
    std::transform(state.foot, state.foot + stance.limb_count, these.begin(), bears);
    return these;
}

Places places_of(const brace_stance_t &stance, const brace_stance_state_t &state)
{
    Places places;
    for (int i = 0; i < stance.limb_count; i++) {
        places[i] = vec3(state.foot[i].place_mm);
    }
    return places;
}

void keep(const brace_stance_t &stance, const brace_stance_load_t &load, const Rest &rest, brace_stance_state_t &state)
{
    state.load = load;
    copy(rest.body.head<3>(), state.displacement_mm);
    copy(rest.body.tail<3>(), state.rotation_rad);
    for (int i = 0; i < stance.limb_count; i++) {
        copy(rest.place[i], state.foot[i].place_mm);
        copy(rest.force[i], state.foot[i].force_n);
        state.foot[i].contact = rest.contact[i];
    }
}

bool is_as_before(const brace_stance_t &stance, const Rest &rest, const brace_stance_state_t &state)
{
    for (int i = 0; i < stance.limb_count; i++) {
        if (rest.contact[i] == BRACE_FOOT_SLIDES || (rest.contact[i] == BRACE_FOOT_STICKS) != bears(state.foot[i])) {
            return false;
        }
    }
    return true;
}

// The smallest factor at which a force that begins within its cone leaves it; infinity: it never does.
double leaves_cone(double friction, double pressing, double pressing_more, const Eigen::Vector2d &along,
                   const Eigen::Vector2d &along_more, double ignored_n)
{
    const double never = std::numeric_limits<double>::infinity();
    const double lifts = pressing_more < 0.0 ? std::fmax(0.0, -pressing / pressing_more) : never;
    const double mu2 = friction * friction;
    const double a = along_more.squaredNorm() - mu2 * pressing_more * pressing_more;
    const double b = along.dot(along_more) - mu2 * pressing * pressing_more;
    const double margin = friction * pressing - along.norm();
    const double c = along.squaredNorm() - mu2 * pressing * pressing;
    double slides = never;
    if (margin <= ignored_n) { // on the cone: outwards at once, or it comes back on its other side
        slides = b > 0.0 ? 0.0 : (a > 0.0 ? -2.0 * b / a : never);
    } else if (a > 0.0 || (b > 0.0 && b * b >= a * c)) { // c < 0: the smallest positive root of a s^2 + 2 b s + c
        slides = -c / (b + std::sqrt(std::fmax(0.0, b * b - a * c)));
    }
    return std::fmin(lifts, slides);
}

// The first foot that leaves its cone between a load and the same with more; the law's own change with the load's
// turning is that at `turned` of it.
brace_stance_slip_t first_of(const brace_stance_t &stance, const Body &body, const Places &places, const Vec6 &load,
                             const Vec6 &more)
{
    brace_stance_slip_t first{std::numeric_limits<double>::infinity(), -1, BRACE_FOOT_SLIDES};
    const Vec6 before = body.displacement(places, load), after = body.displacement(places, load + more);
    double size_n = 0.0;
    for (int i = 0; i < stance.limb_count; i++) {
        size_n += body.bears(i) ? body.force(i, places[i], before).norm() : 0.0;
    }
    for (int i = 0; i < stance.limb_count; i++) {
        if (!body.bears(i)) {
            continue;
        }
        const Ground ground = ground_of(stance.limb[i]);
        const Vec3 force = body.force(i, places[i], before), change = body.force(i, places[i], after) - force;
        const double pressing = ground.normal.dot(force) + stance.limb[i].grip_n;
        const double pressing_more = ground.normal.dot(change);
        const double factor =
            leaves_cone(stance.limb[i].friction_ratio, pressing, pressing_more, ground.along.transpose() * force,
                        ground.along.transpose() * change, 1e-9 * size_n);
        if (factor < first.factor) {
            const bool lifts = pressing + factor * pressing_more <= 1e-9 * size_n;
            first = {factor, i,
                     !lifts                        ? BRACE_FOOT_SLIDES
                     : stance.limb[i].grip_n > 0.0 ? BRACE_FOOT_LET_GO
                                                   : BRACE_FOOT_OPEN};
        }
    }
    return first;
}

} // namespace

void brace_stance_load_add(brace_stance_load_t *load, const double force_n[3], const double at_mm[3])
{
    const Vec3 force = vec3(force_n), at = vec3(at_mm), moment = at.cross(force);
    const Mat3 turning = cross(force) * cross(at);
    for (int i = 0; i < 3; i++) {
        load->force_n[i] += force[i];
        load->moment_n_mm[i] += moment[i];
        for (int j = 0; j < 3; j++) {
            load->turning_n_mm[3 * i + j] += turning(i, j);
        }
    }
}

int32_t brace_stance_place(const brace_stance_t *stance, const double *offset_mm, brace_stance_state_t *state)
{
    if (!is_stance(*stance) || (offset_mm && !is_within(offset_mm, 3 * stance->limb_count, place_most_mm))) {
        return BRACE_STANCE_E_INPUT;
    }
    *state = brace_stance_state_t{};
    for (int i = 0; i < stance->limb_count; i++) {
        brace_stance_foot_t &foot = state->foot[i];
        if (offset_mm) {
            std::copy_n(offset_mm + 3 * i, 3, foot.place_mm);
        }
        foot.ground_mm = vec3(stance->limb[i].normal).dot(vec3(foot.place_mm));
    }
    return BRACE_STANCE_OK;
}

int32_t brace_stance_settle(const brace_stance_t *stance, const brace_stance_load_t *load, int32_t slide_steps,
                            brace_stance_state_t *state, double *share)
{
    if (!is_stance(*stance) || !is_load(*load) || slide_steps < 1 || slide_steps > 1000) {
        return BRACE_STANCE_E_INPUT;
    }
    brace_stance_state_t at = *state;
    const brace_stance_load_t from = at.load, way = along(*load, from, -1.0);
    double gone = 0.0, whole = 1.0;
    int halvings = 0;
    while (gone < 1.0) {
        const double to = gone + whole < whole_way ? gone + whole : 1.0;
        const brace_stance_load_t next = to < 1.0 ? along(from, way, to) : *load;
        Rest rest;
        const int32_t status = step(*stance, load_of(next), at, rest);
        if (status == BRACE_STANCE_E_LOOSE) {
            return status;
        }
        if (status != BRACE_STANCE_OK) {
            if (++halvings > halvings_most) {
                *state = at;
                if (share) {
                    *share = gone;
                }
                return BRACE_STANCE_E_NO_REST;
            }
            whole = 0.5 * (to - gone);
            continue;
        }
        if (whole == 1.0 && slide_steps > 1 && !is_as_before(*stance, rest, at)) {
            // to where the first foot moves in one step, and on in small ones
            brace_stance_slip_t slip{};
            const bool is_known = brace_stance_first_slip(stance, &way, 1.0, &at, &slip) == BRACE_STANCE_OK;
            const double first = is_known && slip.factor < 1.0 ? slip.factor : 0.0;
            if (first > 0.0 && step(*stance, load_of(along(from, way, first)), at, rest) == BRACE_STANCE_OK) {
                keep(*stance, along(from, way, first), rest, at);
                gone = first;
            }
            whole = (1.0 - gone) / slide_steps;
            continue;
        }
        keep(*stance, next, rest, at);
        gone = to;
    }
    *state = at;
    if (share) {
        *share = 1.0;
    }
    return BRACE_STANCE_OK;
}

int32_t brace_stance_first_slip(const brace_stance_t *stance, const brace_stance_load_t *further, double most,
                                const brace_stance_state_t *state, brace_stance_slip_t *slip)
{
    if (!is_stance(*stance) || !is_load(*further) || !(most >= 0.0 && most <= 1e9)) {
        return BRACE_STANCE_E_INPUT;
    }
    const Places places = places_of(*stance, *state);
    const Load load = load_of(state->load), more = load_of(*further);
    brace_stance_slip_t first{0.0, -1, BRACE_FOOT_SLIDES};
    for (int round = 0; round < 4; round++) { // the load's own turning is that at the slip
        const double at = std::isfinite(first.factor) ? std::fmin(first.factor, most) : most;
        Load turned = load;
        if (round > 0) {
            turned.turning += at * more.turning;
        }
        Body body;
        if (!body.assemble(*stance, turned, bearing(*stance, *state))) {
            if (round == 0) {
                return BRACE_STANCE_E_LOOSE;
            }
            break;
        }
        first = first_of(*stance, body, places, load.wrench, more.wrench);
    }
    if (!(first.factor <= most)) {
        first = {std::numeric_limits<double>::infinity(), -1, BRACE_FOOT_SLIDES};
    }
    *slip = first;
    return BRACE_STANCE_OK;
}

void brace_stance_lift(brace_stance_state_t *state, int32_t limb)
{
    state->foot[limb].contact = BRACE_FOOT_LET_GO;
}

double brace_stance_margin_n(const brace_stance_limb_t *limb, const double force_n[3])
{
    const Vec3 force = vec3(force_n), normal = vec3(limb->normal);
    const double pressing = normal.dot(force);
    return limb->friction_ratio * (pressing + limb->grip_n) - (force - pressing * normal).norm();
}

int32_t brace_stance_linear(const brace_stance_t *stance, const brace_stance_load_t *load,
                            const brace_stance_state_t *state, double *stiffness, double *at_rest)
{
    if (!is_stance(*stance) || !is_load(*load)) {
        return BRACE_STANCE_E_INPUT;
    }
    const Load given = load_of(*load);
    Body body;
    if (!body.assemble(*stance, given, bearing(*stance, *state))) {
        return BRACE_STANCE_E_LOOSE;
    }
    const int n = stance->limb_count;
    const Places places = places_of(*stance, *state);
    const Vec6 moved = body.displacement(places, given.wrench);
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> s(stiffness, 3 * n, 3 * n);
    Eigen::Map<Eigen::VectorXd> f(at_rest, 3 * n);
    s.setZero();
    f.setZero();
    for (int i = 0; i < n; i++) {
        if (body.bears(i)) {
            f.segment<3>(3 * i) = body.force(i, places[i], moved);
            for (int j = 0; j < n; j++) {
                if (body.bears(j)) {
                    s.block<3, 3>(3 * i, 3 * j) = body.stiffness(i, j);
                }
            }
        }
    }
    return BRACE_STANCE_OK;
}

const char *brace_stance_status_text(int32_t status)
{
    switch (status) {
    case BRACE_STANCE_OK: return "all is well";
    case BRACE_STANCE_E_INPUT: return "a number is not finite or outside its range";
    case BRACE_STANCE_E_LOOSE: return "the limbs do not hold the body: it can move or turn without resistance";
    case BRACE_STANCE_E_NO_REST: return "no equilibrium: too many feet slide or are off the ground";
    default: return "an unknown status";
    }
}
