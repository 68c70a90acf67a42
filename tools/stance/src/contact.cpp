#include "contact.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace brace::stance {

namespace {

constexpr int changes_most = 8 * limbs_most; // of contacts in a step, before it is given up
constexpr int iterations_most = 14;
constexpr int stalls_most = 2;        // iterations that do not halve what is left of the law: Newton has lost its way
constexpr double exact_share = 1e-10; // of the forces: what is left of the law of sliding
constexpr double near_share = 1e-4;   // enough to see which contact's law is broken
constexpr double tie_share = 1e-9;    // of friction's most: a force beyond it slides
constexpr double slide_most_mm = 100.0;   // a foot that goes further in one step has no rest
constexpr double spring_ratio = 0.5; // r of a foot over its limb's own K: 0.1 and 1 find the rest more slowly or not
constexpr double stride_most = 0.15; // of the forces: what r makes of how far an iteration slides a foot

// One implicit step. All feet may slide at first, which mostly finds the rest within a few iterations. Where that
// fails, the step begins again, and feet may slide one after the other, the one that breaks its law most first.
class Step {
public:
    Step(const brace_stance_t &stance, const Load &load, const brace_stance_state_t &from)
        : stance_(stance), load_(load), from_(from), count_(stance.limb_count)
    {
        for (int i = 0; i < count_; i++) {
            ground_[i] = ground_of(stance.limb[i]);
            const Mat3 k = mat3(stance.limb[i].k_n_per_mm);
            spring_[i] = 0.5 * spring_ratio * (k.trace() - ground_[i].normal.dot(k * ground_[i].normal));
        }
        begin(true);
    }

    int32_t run(Rest &rest)
    {
        bool is_assembled = false, is_exact = all_may_slide_;
        for (int change = 0; change < changes_most; change++) {
            if (!is_assembled) {
                if (!assemble()) {
                    return change == 0 ? BRACE_STANCE_E_LOOSE : BRACE_STANCE_E_NO_REST;
                }
                is_assembled = true;
                forces();
            }
            Change next = worst();
            if (next.limb < 0 || !all_may_slide_) {
                if (!slide(is_exact ? exact_share : near_share)) {
                    if (!all_may_slide_) {
                        return BRACE_STANCE_E_NO_REST;
                    }
                    begin(false);
                    is_assembled = is_exact = false;
                    continue;
                }
                next = worst();
            }
            if (next.limb < 0 && is_exact) {
                rest.body = body_;
                for (int i = 0; i < count_; i++) {
                    rest.force[i] = force_[i];
                    rest.place[i] = on_ground(i) ? place_[i] : hanging_place(stance_.limb[i], body_);
                    rest.contact[i] = contact_[i];
                }
                return BRACE_STANCE_OK;
            }
            is_exact = all_may_slide_ || next.limb < 0; // the contacts are found, perhaps: now to the end
            if (next.limb >= 0) {
                is_assembled = !apply(next);
            }
        }
        return BRACE_STANCE_E_NO_REST;
    }

private:
    struct Change {
        int limb;
        int32_t contact;
    };

    // Every foot where it was.
    void begin(bool all_may_slide)
    {
        all_may_slide_ = all_may_slide;
        may_slide_.fill(all_may_slide);
        for (int i = 0; i < count_; i++) {
            const brace_stance_foot_t &foot = from_.foot[i];
            contact_[i] = foot.contact == BRACE_FOOT_SLIDES ? int32_t{BRACE_FOOT_STICKS} : foot.contact;
            stand(i, vec3(foot.place_mm));
        }
    }

    void stand(int i, const Vec3 &place)
    {
        stood_[i] = place_[i] = place;
        slid_[i].setZero();
    }

    bool on_ground(int i) const { return contact_[i] == BRACE_FOOT_STICKS || contact_[i] == BRACE_FOOT_SLIDES; }

    double pressing_n(int i) const { return ground_[i].normal.dot(force_[i]) + stance_.limb[i].grip_n; }

    double friction_most_n(int i) const { return stance_.limb[i].friction_ratio * std::fmax(0.0, pressing_n(i)); }

    bool assemble()
    {
        for (auto &row : has_by_slide_) {
            row.fill(false);
        }
        std::array<bool, limbs_most> bears{};
        for (int i = 0; i < count_; i++) {
            bears[i] = on_ground(i);
        }
        return equilibrium_.assemble(stance_, load_, bears);
    }

    void forces()
    {
        body_ = equilibrium_.displacement(place_, load_.wrench);
        for (int i = 0; i < count_; i++) {
            force_[i] = on_ground(i) ? equilibrium_.force(i, place_[i], body_) : Vec3(Vec3::Zero());
        }
    }

    // How a limb's force changes as another foot goes along its ground.
    const Eigen::Matrix<double, 3, 2> &by_slide(int limb, int foot)
    {
        if (!has_by_slide_[limb][foot]) {
            by_slide_[limb][foot] = equilibrium_.stiffness(limb, foot) * ground_[foot].along;
            has_by_slide_[limb][foot] = true;
        }
        return by_slide_[limb][foot];
    }

    // Which feet slide, and the direction of y of those; returns whether one sticks again.
    bool sort()
    {
        bool has_stuck = false;
        slides_ = 0;
        for (int i = 0; i < count_; i++) {
            if (!on_ground(i)) {
                continue;
            }
            const Eigen::Vector2d y = ground_[i].along.transpose() * force_[i] - spring_[i] * slid_[i];
            length_n_[i] = y.norm();
            if (may_slide_[i] && length_n_[i] > (1.0 + tie_share) * friction_most_n(i)) {
                contact_[i] = BRACE_FOOT_SLIDES;
                towards_[i] = y / length_n_[i];
                sliding_[slides_++] = i;
            } else if (contact_[i] == BRACE_FOOT_SLIDES) {
                contact_[i] = BRACE_FOOT_STICKS;
                stand(i, stood_[i]);
                has_stuck = true;
            }
        }
        return has_stuck;
    }

    // Coulomb's law as one equation of each foot (Alart and Curnier, Computer Methods in Applied Mechanics and
    // Engineering 92, 1991): the force along the ground is the point nearest to y = force - r slid of the disk that
    // friction allows. Inside it the foot sticks, slid = 0; outside, the force is the disk's edge. Newton's method on
    // how far the feet slide, which of them do found anew in every iteration. An iteration that goes too far, as where
    // nearly all feet slide and hardly anything holds the body, goes a part of its way. share: of the forces, that may
    // be left.
    bool slide(double share)
    {
        using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2 * limbs_most, 2 * limbs_most>;
        using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * limbs_most, 1>;
        double least_n = std::numeric_limits<double>::infinity();
        int stalls = 0;
        for (int iteration = 0; iteration < iterations_most; iteration++) {
            const bool has_stuck = sort();
            if (has_stuck) {
                forces();
            }
            if (slides_ == 0) {
                if (has_stuck) {
                    continue;
                }
                return true;
            }
            Vector left(2 * slides_);
            Matrix by(2 * slides_, 2 * slides_);
            double size_n = 0.0;
            for (int i = 0; i < count_; i++) {
                size_n += on_ground(i) ? force_[i].norm() + stance_.limb[i].grip_n : 0.0;
            }
            for (int a = 0; a < slides_; a++) {
                const int i = sliding_[a];
                const double most_n = friction_most_n(i);
                left.segment<2>(2 * a) = ground_[i].along.transpose() * force_[i] - most_n * towards_[i];
                const Eigen::Matrix2d turns =
                    most_n / length_n_[i] * (Eigen::Matrix2d::Identity() - towards_[i] * towards_[i].transpose());
                // rows of the force that count
                Eigen::Matrix<double, 2, 3> rows = ground_[i].along.transpose() - turns * ground_[i].along.transpose();
                if (most_n > 0.0) {
                    rows -= stance_.limb[i].friction_ratio * towards_[i] * ground_[i].normal.transpose();
                }
                for (int b = 0; b < slides_; b++) {
                    by.block<2, 2>(2 * a, 2 * b) = rows * by_slide(i, sliding_[b]);
                }
                by.block<2, 2>(2 * a, 2 * a) += spring_[i] * turns;
            }
            const double left_n = left.lpNorm<Eigen::Infinity>();
            if (!has_stuck && left_n <= share * size_n) {
                return true;
            }
            stalls = left_n < 0.5 * least_n ? 0 : stalls + 1;
            least_n = stalls ? least_n : left_n;
            const Vector go = by.partialPivLu().solve(-left);
            if (stalls > stalls_most || !go.allFinite()) {
                return false;
            }
            double stride_n = 0.0;
            for (int a = 0; a < slides_; a++) {
                stride_n = std::fmax(stride_n, spring_[sliding_[a]] * go.segment<2>(2 * a).norm());
            }
            const double part = std::fmin(1.0, stride_most * size_n / stride_n); // stride_n 0: nothing to go
            for (int a = 0; a < slides_; a++) {
                const int i = sliding_[a];
                slid_[i] += part * go.segment<2>(2 * a);
                if (slid_[i].norm() > slide_most_mm) {
                    return false;
                }
                place_[i] = stood_[i] + ground_[i].along * slid_[i];
            }
            forces();
        }
        return false;
    }

    // The contact whose law is broken most, and what it is instead.
    Change worst() const
    {
        Change found{-1, 0};
        double most = 0.0;
        double size_n = load_.wrench.head<3>().norm();
        for (int i = 0; i < count_; i++) {
            size_n += force_[i].norm();
        }
        const double ignored_n = 1e-9 * size_n;
        auto offer = [&](double broken_n, int limb, int32_t contact) {
            if (broken_n > most && broken_n > ignored_n) {
                most = broken_n;
                found = {limb, contact};
            }
        };
        for (int i = 0; i < count_; i++) {
            const brace_stance_limb_t &limb = stance_.limb[i];
            if (on_ground(i)) {
                offer(-pressing_n(i), i, limb.grip_n > 0.0 ? BRACE_FOOT_LET_GO : BRACE_FOOT_OPEN);
                if (!may_slide_[i] && pressing_n(i) >= 0.0) {
                    offer((ground_[i].along.transpose() * force_[i]).norm() - friction_most_n(i), i, BRACE_FOOT_SLIDES);
                }
            } else if (contact_[i] == BRACE_FOOT_OPEN) {
                const Vec3 hangs = hanging_place(limb, body_);
                const double below_mm = from_.foot[i].ground_mm - ground_[i].normal.dot(hangs);
                offer(below_mm * mat3(limb.k_n_per_mm).trace(), i, BRACE_FOOT_STICKS);
            }
        }
        return found;
    }

    // Returns whether other limbs bear the body now.
    bool apply(const Change &change)
    {
        const int i = change.limb;
        if (change.contact == BRACE_FOOT_SLIDES) {
            may_slide_[i] = true;
            return false;
        }
        const bool did_bear = on_ground(i);
        if (contact_[i] == BRACE_FOOT_OPEN) { // it comes down where it hangs now
            const Vec3 hangs = hanging_place(stance_.limb[i], body_), normal = ground_[i].normal;
            stood_[i] = hangs + (from_.foot[i].ground_mm - normal.dot(hangs)) * normal;
        }
        stand(i, stood_[i]);
        contact_[i] = change.contact;
        return on_ground(i) != did_bear;
    }

    const brace_stance_t &stance_;
    const Load &load_;
    const brace_stance_state_t &from_;
    const int count_;
    bool all_may_slide_ = true;
    std::array<Ground, limbs_most> ground_;
    std::array<int32_t, limbs_most> contact_;
    std::array<bool, limbs_most> may_slide_;
    std::array<double, limbs_most> spring_; // r [N/mm]
    Places stood_, place_, force_;
    std::array<Eigen::Vector2d, limbs_most> slid_, towards_; // along the ground in this step [mm]; y's direction
    std::array<double, limbs_most> length_n_; // y's
    std::array<int, limbs_most> sliding_;
    int slides_ = 0;
    Body equilibrium_;
    std::array<std::array<Eigen::Matrix<double, 3, 2>, limbs_most>, limbs_most> by_slide_;
    std::array<std::array<bool, limbs_most>, limbs_most> has_by_slide_;
    Vec6 body_;
};

} // namespace

Ground ground_of(const brace_stance_limb_t &limb)
{
    // Duff and others, Journal of Computer Graphics Techniques 6, 2017: no root, and one division
    Ground ground;
    ground.normal = vec3(limb.normal);
    const double x = ground.normal.x(), y = ground.normal.y(), z = ground.normal.z();
    const double sign = std::copysign(1.0, z), a = -1.0 / (sign + z), b = x * y * a;
    ground.along << 1.0 + sign * x * x * a, b, //
        sign * b, sign + y * y * a, //
        -sign * x, -y;
    return ground;
}

int32_t step(const brace_stance_t &stance, const Load &load, const brace_stance_state_t &from, Rest &rest)
{
    return Step(stance, load, from).run(rest);
}

} // namespace brace::stance
