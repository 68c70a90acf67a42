#include "plant/condensed.h"

namespace brace::plant {
namespace {

template <class Number> using Vec = Eigen::Matrix<Number, 2, 1>;
template <class Number> using Mat = Eigen::Matrix<Number, 2, 2>;

template <class Number> Vec<Number> quarter_turn(const Vec<Number> &v)
{
    return {-v.y(), v.x()};
}

// A body's turn, from half its angle: what a small turn moves keeps all its digits.
template <class Number> struct Turn {
    void by(const Number &angle_rad)
    {
        Number half_sin, half_cos;
        sin_cos(0.5 * angle_rad, half_sin, half_cos);
        sin = 2.0 * half_sin * half_cos;
        versine = 2.0 * half_sin * half_sin;
    }

    Vec<Number> moved(const Vec<Number> &v) const { return sin * quarter_turn(v) - versine * v; }

    Number sin, versine; // 1 - cos
};

// What a body yields, seen from the robot.
template <class Number> struct Yielding {
    Yielding(const BodyOf<Number> &body, const Turn<Number> &turn)
    {
        const Number cos_2 = 1.0 - 2.0 * turn.sin * turn.sin;
        const Number sin_2 = 2.0 * turn.sin * (1.0 - turn.versine);
        const Vec<Number> &d = body.deviation_mm_per_n;
        const Number deviation = d.x() * cos_2 - d.y() * sin_2;
        xx = body.mean_mm_per_n + deviation;
        xz = d.x() * sin_2 + d.y() * cos_2;
        zz = body.mean_mm_per_n - deviation;
    }

    Vec<Number> stretch_mm(const Vec<Number> &force_n) const
    {
        return {xx * force_n.x() + xz * force_n.y(), xz * force_n.x() + zz * force_n.y()};
    }

    Number xx, xz, zz;
};

template <class Number> void add_square(Mat<Number> &sum, const Number &factor, const Number &x, const Number &z)
{
    sum(0, 0) += factor * x * x;
    sum(0, 1) += factor * x * z;
    sum(1, 1) += factor * z * z;
}

} // namespace

template <class Number>
void CondensedOf<Number>::linearise(const StructureOf<Number> &structure,
                                    const std::array<JointHingeOf<Number>, 2> &joint, const Shape &shape)
{
    count_ = static_cast<std::size_t>(structure.body_count);
    std::array<Turn<Number>, kMostBodies> turns; // of the bodies
    Number angle_rad = 0.0;
    for (std::size_t i = 0; i < count_; ++i) {
        angle_rad += shape.turn_rad[i];
    }
    for (std::size_t i = count_; i-- > 0;) {
        turns[i].by(angle_rad);
        angle_rad -= shape.turn_rad[i];
    }

    Vec<Number> tip_mm = Vec<Number>::Zero();
    Mat<Number> compliance_mm_per_n = Mat<Number>::Zero();
    Mat<Number> torque_n_mm_per_rad = Mat<Number>::Zero();
    std::array<Vec<Number>, 2> lever_mm{Vec<Number>::Zero(), Vec<Number>::Zero()};
    std::array<Number, 2> torques_n_mm{};
    Number negative_pivots = 0.0;
    Vec<Number> force_n = shape.force_n; // that acts beyond where we are
    Number curvature = 0.0;              // W_phiphi
    Vec<Number> lever = Vec<Number>::Zero();
    std::array<Number, 2> by_turn{};
    Number torque_n_mm = 0.0;
    for (std::size_t i = count_; i-- > 0;) {
        const BodyOf<Number> &body = structure.body[i];
        const Turn<Number> &turn = turns[i];
        const auto let_yield = [&]() __attribute__((always_inline))
        {
            const Yielding<Number> spring(body, turn);
            const Vec<Number> turned_force = quarter_turn(force_n);
            const Vec<Number> stretch = spring.stretch_mm(force_n);
            const Vec<Number> by_turned = spring.stretch_mm(turned_force);
            compliance_mm_per_n(0, 0) += spring.xx;
            compliance_mm_per_n(0, 1) += spring.xz;
            compliance_mm_per_n(1, 1) += spring.zz;
            curvature += turned_force.dot(by_turned) - stretch.dot(force_n);
            lever += quarter_turn(stretch) - by_turned;
            torque_n_mm += quarter_turn(stretch).dot(force_n);
            tip_mm += stretch;
        };
        force_n += body.end_weight_n * structure.down;
        if (body.yields == Yields::at_end) {
            let_yield();
        }
        const Vec<Number> moved = turn.moved(body.extent_mm);
        const Vec<Number> extent = body.extent_mm + moved;
        tip_mm += moved;
        lever += quarter_turn(extent);
        curvature -= extent.dot(force_n);
        torque_n_mm += quarter_turn(extent).dot(force_n);
        if (is_there(body.weight_n)) {
            const Vec<Number> arm = body.weight_arm_mm + turn.moved(body.weight_arm_mm);
            curvature -= body.weight_n * arm.dot(structure.down);
            torque_n_mm += body.weight_n * (arm.x() * structure.down.y() - arm.y() * structure.down.x());
            force_n += body.weight_n * structure.down;
        }
        if (body.yields == Yields::at_root) {
            let_yield();
        }

        const bool is_joint = body.joint != kElastic;
        const auto k = static_cast<std::size_t>(is_joint ? body.joint : 0);
        const Number compliance = is_joint ? joint[k].compliance_rad_per_n_mm : body.hinge_rad_per_n_mm;
        const Number strained_rad = shape.turn_rad[i] - (is_joint ? joint[k].unstrained_rad : Number(0.0));
        const Number load_n_mm = is_joint ? structure.joint_load_n_mm[body.joint] : Number(0.0);
        const Number pivot = 1.0 - compliance * curvature;
        const Number per_pivot = 1.0 / pivot;
        Hinge &hinge = hinge_[i];
        hinge = {body.joint,
                 curvature,
                 lever,
                 by_turn,
                 torque_n_mm + load_n_mm,
                 compliance * per_pivot,
                 (compliance * (torque_n_mm + load_n_mm) - strained_rad) * per_pivot};
        negative_pivots += one_if_negative(pivot);
        add_square(compliance_mm_per_n, hinge.turn_per_torque, lever.x(), lever.y());
        add_square(torque_n_mm_per_rad, hinge.turn_per_torque, by_turn[0], by_turn[1]);
        for (const std::size_t j : {0, 1}) {
            lever_mm[j] += hinge.turn_per_torque * by_turn[j] * lever;
            torques_n_mm[j] += hinge.lacks_rad * by_turn[j];
            by_turn[j] *= per_pivot;
        }
        tip_mm += hinge.lacks_rad * lever;
        torque_n_mm += hinge.lacks_rad * curvature;
        lever *= per_pivot;
        curvature *= per_pivot;
        if (is_joint) {
            lever_mm[k] += lever;
            torques_n_mm[k] += torque_n_mm + load_n_mm;
            torque_n_mm_per_rad(body.joint, body.joint) += curvature;
            torque_n_mm_per_rad(0, 1) += by_turn[1 - k];
            by_turn[k] += curvature;
        }
    }
    compliance_mm_per_n(0, 0) += structure.base_mm_per_n.x();
    compliance_mm_per_n(1, 1) += structure.base_mm_per_n.y();
    compliance_mm_per_n(1, 0) = compliance_mm_per_n(0, 1);
    torque_n_mm_per_rad(1, 0) = torque_n_mm_per_rad(0, 1);
    tip_mm += structure.base_mm_per_n.cwiseProduct(force_n);
    tangent_ = {tip_mm, torques_n_mm, compliance_mm_per_n, lever_mm, torque_n_mm_per_rad, negative_pivots};
}

template <class Number>
void CondensedOf<Number>::go(const ChangeOf<Number, 2> &change, const Shape &shape, Followed &followed) const
{
    Number turned_rad = 0.0; // the present body
    Number most_rad = 0.0;
    for (std::size_t i = 0; i < count_; ++i) {
        const Hinge &hinge = hinge_[i];
        const auto k = static_cast<std::size_t>(hinge.joint);
        const bool is_joint = hinge.joint != kElastic;
        const Number kept_rad = is_joint ? change.turn_rad[k] : Number(0.0);
        turned_rad += kept_rad;
        const Number more_n_mm = hinge.lever_mm.dot(change.force_n) + hinge.by_turn_n_mm_per_rad[0] * change.turn_rad[0]
                                 + hinge.by_turn_n_mm_per_rad[1] * change.turn_rad[1];
        const Number sprung_rad =
            hinge.lacks_rad + hinge.turn_per_torque * (more_n_mm + hinge.curvature_n_mm_per_rad * turned_rad);
        turned_rad += sprung_rad;
        followed.shape.turn_rad[i] = shape.turn_rad[i] + (kept_rad + sprung_rad);
        if (is_joint) {
            followed.torque_n_mm[k] = hinge.torque_n_mm + more_n_mm + hinge.curvature_n_mm_per_rad * turned_rad;
        }
        most_rad = larger(most_rad, magnitude(turned_rad));
    }
    followed.shape.force_n = shape.force_n + change.force_n;
    followed.most_rad = most_rad;
}

template <>
void CondensedOf<double>::about(const Structure &structure, const std::array<JointHinge, 2> &joint, const Shape &shape)
{
    linearise(structure, joint, shape);
}

template <> void CondensedOf<double>::follow(const Change<2> &change, const Shape &shape, Followed &followed) const
{
    go(change, shape, followed);
}

// Where the machine has instructions for four numbers they are taken, where not, pairs. Nothing is fused, so the bits
// are the same.
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) \
    && !defined(__SANITIZE_THREAD__)
#define BRACE_FOUR_AT_ONCE __attribute__((flatten, target_clones("avx2", "default")))
#else
#define BRACE_FOUR_AT_ONCE __attribute__((flatten))
#endif

template <>
BRACE_FOUR_AT_ONCE void CondensedOf<Lanes>::about(const StructureOf<Lanes> &structure,
                                                  const std::array<JointHingeOf<Lanes>, 2> &joint, const Shape &shape)
{
    linearise(structure, joint, shape);
}

template <>
BRACE_FOUR_AT_ONCE void CondensedOf<Lanes>::follow(const ChangeOf<Lanes, 2> &change, const Shape &shape,
                                                   Followed &followed) const
{
    go(change, shape, followed);
}

} // namespace brace::plant
