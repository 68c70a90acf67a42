#include "contact.h"

#include <Eigen/LU>
#include <cmath>

namespace brace::stance {

namespace {

constexpr int changes_most = 8 * limbs_most;      // of contacts in a step, before it is given up
constexpr int iterations_most = 25;
constexpr double exact_share = 1e-10;             // of the forces: what is left of the law of sliding
constexpr double near_share = 1e-4; // enough to see which contact's law is broken
constexpr double slide_most_mm = 100.0;           // a foot that goes further in one step has no rest
constexpr double turn_most_rad = 0.5;             // of a sliding direction in one iteration

// Unknowns of the sliding feet: how far each slides and in which direction of its ground.
struct Slide {
    int limb;
    double angle_rad, way_mm;
    Eigen::Vector2d direction() const { return {std::cos(angle_rad), std::sin(angle_rad)}; }
};

class Step {
public:
    Step(const brace_stance_t &stance, const Load &load, const brace_stance_state_t &from)
        : stance_(stance), load_(load), from_(from), count_(stance.limb_count)
    {
        for (int i = 0; i < count_; i++) {
            ground_[i] = ground_of(stance.limb[i]);
            contact_[i] = from.foot[i].contact == BRACE_FOOT_SLIDES ? int32_t{BRACE_FOOT_STICKS} : from.foot[i].contact;
            stood_[i] = place_[i] = vec3(from.foot[i].place_mm);
        }
    }

    int32_t run(Rest &rest)
    {
        bool is_assembled = false, is_exact = false;
        for (int change = 0; change < changes_most; change++) {
            if (!is_assembled && !assemble()) {
                return change == 0 ? BRACE_STANCE_E_LOOSE : BRACE_STANCE_E_NO_REST;
            }
            is_assembled = true;
            if (!slide(is_exact ? exact_share : near_share)) {
                return BRACE_STANCE_E_NO_REST;
            }
            const Change next = worst();
            if (next.limb < 0 && slides_ > 0 && !is_exact) {
                is_exact = true; // the contacts are found, perhaps: now to the end
                continue;
            }
            is_exact = false;
            if (next.limb < 0) {
                rest.body = body_;
                for (int i = 0; i < count_; i++) {
                    rest.force[i] = force_[i];
                    rest.place[i] = on_ground(i) ? place_[i] : hanging_place(stance_.limb[i], body_);
                    rest.contact[i] = contact_[i];
                }
                return BRACE_STANCE_OK;
            }
            is_assembled = !apply(next);
        }
        return BRACE_STANCE_E_NO_REST;
    }

private:
    struct Change {
        int limb;
        int32_t contact;
    };

    bool on_ground(int i) const { return contact_[i] == BRACE_FOOT_STICKS || contact_[i] == BRACE_FOOT_SLIDES; }

    double pressing_n(int i) const { return ground_[i].normal.dot(force_[i]) + stance_.limb[i].grip_n; }

    double beyond_cone_n(int i) const
    {
        const Eigen::Vector2d along = ground_[i].along.transpose() * force_[i];
        return along.norm() - stance_.limb[i].friction_ratio * pressing_n(i);
    }

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

    void put(const Slide &slide)
    {
        place_[slide.limb] = stood_[slide.limb] + ground_[slide.limb].along * (slide.way_mm * slide.direction());
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

    // Newton's method on f_t + friction (f_n + grip) direction = 0 of every sliding foot, in its way and direction.
    // share: of the forces, that may be left of the law.
    bool slide(double share)
    {
        forces();
        if (slides_ == 0) {
            return true;
        }
        using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2 * limbs_most, 2 * limbs_most>;
        using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * limbs_most, 1>;
        for (int iteration = 0; iteration < iterations_most; iteration++) {
            Vector left(2 * slides_);
            Matrix by(2 * slides_, 2 * slides_);
            double size_n = 0.0;
            for (int a = 0; a < slides_; a++) {
                const int i = slide_[a].limb;
                const double friction = stance_.limb[i].friction_ratio;
                const Eigen::Vector2d direction = slide_[a].direction();
                const Eigen::Vector2d turned(-direction.y(), direction.x());
                // rows of the force that count: along + friction direction normal
                const Eigen::Matrix<double, 2, 3> rows =
                    ground_[i].along.transpose() + friction * direction * ground_[i].normal.transpose();
                left.segment<2>(2 * a) = rows * force_[i] + friction * stance_.limb[i].grip_n * direction;
                size_n += force_[i].norm() + stance_.limb[i].grip_n;
                for (int b = 0; b < slides_; b++) {
                    const int j = slide_[b].limb;
                    const Eigen::Vector2d towards = slide_[b].direction();
                    const Eigen::Matrix2d s = rows * by_slide(i, j);
                    by.block<2, 1>(2 * a, 2 * b) = s * towards;
                    by.block<2, 1>(2 * a, 2 * b + 1) =
                        slide_[b].way_mm * s * Eigen::Vector2d(-towards.y(), towards.x());
                }
                by.block<2, 1>(2 * a, 2 * a + 1) += friction * pressing_n(i) * turned;
            }
            if (left.lpNorm<Eigen::Infinity>() <= share * size_n) {
                return true;
            }
            const Vector go = by.partialPivLu().solve(-left);
            if (!go.allFinite()) {
                return false;
            }
            for (int a = 0; a < slides_; a++) {
                slide_[a].way_mm += go[2 * a];
                slide_[a].angle_rad += std::fmax(-turn_most_rad, std::fmin(turn_most_rad, go[2 * a + 1]));
                if (std::fabs(slide_[a].way_mm) > slide_most_mm) {
                    return false;
                }
                put(slide_[a]);
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
            const double pressing = pressing_n(i);
            if (contact_[i] == BRACE_FOOT_STICKS) {
                offer(-pressing, i, limb.grip_n > 0.0 ? BRACE_FOOT_LET_GO : BRACE_FOOT_OPEN);
                if (pressing >= 0.0) {
                    offer(beyond_cone_n(i), i, BRACE_FOOT_SLIDES);
                }
            } else if (contact_[i] == BRACE_FOOT_SLIDES) {
                offer(-pressing, i, limb.grip_n > 0.0 ? BRACE_FOOT_LET_GO : BRACE_FOOT_OPEN);
                const double back_mm = -way_of(i);
                offer(back_mm * mat3(limb.k_n_per_mm).trace(), i, BRACE_FOOT_STICKS);
            } else if (contact_[i] == BRACE_FOOT_OPEN) {
                const Vec3 hangs = hanging_place(limb, body_);
                const double below_mm = from_.foot[i].ground_mm - ground_[i].normal.dot(hangs);
                offer(below_mm * mat3(limb.k_n_per_mm).trace(), i, BRACE_FOOT_STICKS);
            }
        }
        return found;
    }

    double way_of(int limb) const
    {
        for (int a = 0; a < slides_; a++) {
            if (slide_[a].limb == limb) {
                return slide_[a].way_mm;
            }
        }
        return 0.0;
    }

    // Returns whether other limbs bear the body now.
    bool apply(const Change &change)
    {
        const int i = change.limb;
        const bool did_bear = on_ground(i);
        for (int a = 0; a < slides_; a++) {
            if (slide_[a].limb == i) {
                slide_[a] = slide_[--slides_];
                break;
            }
        }
        if (change.contact == BRACE_FOOT_SLIDES) {
            const Eigen::Vector2d along = ground_[i].along.transpose() * force_[i];
            slide_[slides_++] = {i, std::atan2(-along.y(), -along.x()), 0.0};
        } else if (contact_[i] == BRACE_FOOT_OPEN) { // it comes down where it hangs now
            const Vec3 hangs = hanging_place(stance_.limb[i], body_), normal = ground_[i].normal;
            stood_[i] = hangs + (from_.foot[i].ground_mm - normal.dot(hangs)) * normal;
        }
        place_[i] = stood_[i];
        contact_[i] = change.contact;
        return on_ground(i) != did_bear;
    }

    const brace_stance_t &stance_;
    const Load &load_;
    const brace_stance_state_t &from_;
    const int count_;
    std::array<Ground, limbs_most> ground_;
    std::array<int32_t, limbs_most> contact_;
    Places stood_, place_, force_;
    std::array<Slide, limbs_most> slide_;
    int slides_ = 0;
    Body equilibrium_;
    std::array<std::array<Eigen::Matrix<double, 3, 2>, limbs_most>, limbs_most> by_slide_;
    std::array<std::array<bool, limbs_most>, limbs_most> has_by_slide_;
    Vec6 body_;
};

} // namespace

Ground ground_of(const brace_stance_limb_t &limb)
{
    Ground ground;
    ground.normal = vec3(limb.normal);
    Vec3 aside = Vec3::Zero();
    int least = 0;
    ground.normal.cwiseAbs().minCoeff(&least);
    aside[least] = 1.0;
    ground.along.col(0) = ground.normal.cross(aside).normalized();
    ground.along.col(1) = ground.normal.cross(Vec3(ground.along.col(0)));
    return ground;
}

int32_t step(const brace_stance_t &stance, const Load &load, const brace_stance_state_t &from, Rest &rest)
{
    return Step(stance, load, from).run(rest);
}

} // namespace brace::stance
