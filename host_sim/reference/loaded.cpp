#include "reference/loaded.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace brace::reference {
namespace {

constexpr double kRigid = 1e-15; // smallest eigenvalue of C over the largest that counts as yielding
const Vector3d kSideways = {0.0, 1.0, 0.0};
const Vector3d kCounterClockwise = {0.0, -1.0, 0.0}; // turns x towards z

Vector3d along(double angle_rad)
{
    return {std::cos(angle_rad), 0.0, std::sin(angle_rad)};
}

Vector3d across(double angle_rad)
{
    return {-std::sin(angle_rad), 0.0, std::cos(angle_rad)};
}

class Builder {
public:
    explicit Builder(const Weights &weights) : weights_(weights) {}

    std::size_t hinge(const Vector3d &axis, const Vector3d &point, double compliance)
    {
        return add({true, axis, point, 0.0}, compliance);
    }

    std::size_t slide(const Vector3d &direction, double compliance)
    {
        return add({false, direction, Vector3d::Zero(), 0.0}, compliance);
    }

    // A joint, in the list of those that tell their moment.
    void joint(int index, const Vector3d &axis, const Vector3d &point, double compliance)
    {
        limb.mark[index] = limb.chain.weights.size();
        for (const Vector3d &marked : {point, Vector3d(point + axis)}) {
            limb.chain.weights.push_back({limb.chain.springs.size(), marked, Vector3d::Zero()});
        }
        limb.joint[index] = hinge(axis, point, compliance);
    }

    void weight(const Vector3d &point, double weight_n)
    {
        if (weight_n != 0.0) {
            limb.chain.weights.push_back({limb.chain.springs.size(), point, weight_n * weights_.direction});
        }
    }

    // A link from `root` on, in the direction of an angle.
    void link(const LinkCompliance &link, const Vector3d &root, double angle_rad, double length_mm, double weight_n,
              int parts, bool in_space)
    {
        const double m = length_mm > 0.0 ? static_cast<double>(link.moment_transfer) : 0.0;
        const double bending = static_cast<double>(link.bending_mm_per_n);
        const double lateral = in_space ? static_cast<double>(link.lateral_mm_per_n) : 0.0;
        const double torsion = in_space ? static_cast<double>(link.torsion_rad_per_n_mm) : 0.0;
        const double axial = static_cast<double>(link.axial_mm_per_n);
        const double elastic_rad = angle_rad + static_cast<double>(link.tilt_rad);
        const Vector3d line = along(angle_rad);
        const Vector3d elastic_line = along(elastic_rad);
        const Vector3d end = root + length_mm * line;

        const auto mid_length = [&](bool here) {
            if (here) {
                weight(root + 0.5 * length_mm * line, (1.0 - m) * weight_n);
            }
        };

        slide(elastic_line, m * axial);
        mid_length(m == 0.0);
        if (m > 0.0) {
            const bool gauss = parts > 0; // else one hinge in the middle of each part
            const int count = std::abs(parts);
            // The middles alone would bend by 1/(4 count^2) too little.
            const double share = gauss ? 0.5 : 1.0 / (1.0 - 0.25 / (static_cast<double>(count) * count));
            const double per_hinge = share * m * 3.0 / (length_mm * length_mm * count);
            for (int part = 0; part < count; ++part) {
                const auto to_end_mm = [&](double of_part) { return length_mm * (1.0 - (part + of_part) / count); };
                const auto in_plane = [&](double of_part) {
                    hinge(kCounterClockwise, end - to_end_mm(of_part) * elastic_line, per_hinge * bending);
                };
                const auto sideways = [&](double of_part) {
                    hinge(line.cross(kSideways), end - to_end_mm(of_part) * line, per_hinge * lateral);
                };
                const auto twist = [&] { hinge(line, end, m * torsion / count); };
                const auto lump = [&] {
                    weight(end - to_end_mm(0.5) * line, m * weight_n / count);
                    mid_length(2 * part + 1 == count);
                };
                // Turns in space do not commute. The order is the same from both ends of a part (of two parts, where
                // each has one hinge), else the error would fall with the first power of a part's length.
                if (gauss) {
                    const double from_middle = 0.5 / std::sqrt(3.0);
                    in_plane(0.5 - from_middle);
                    sideways(0.5 - from_middle);
                    twist();
                    lump();
                    sideways(0.5 + from_middle);
                    in_plane(0.5 + from_middle);
                } else if (part % 2 == 0) {
                    in_plane(0.5);
                    sideways(0.5);
                    twist();
                    lump();
                } else {
                    twist();
                    sideways(0.5);
                    in_plane(0.5);
                    lump();
                }
                mid_length(2 * part + 2 == count);
            }
        }
        slide(elastic_line, (1.0 - m) * axial);
        slide(across(elastic_rad), (1.0 - m) * bending);
        slide(kSideways, (1.0 - m) * lateral);
        hinge(line, end, (1.0 - m) * torsion);
    }

    LimbChain limb;

private:
    std::size_t add(Spring spring, double compliance)
    {
        if (!(compliance > 0.0)) {
            return LimbChain::npos;
        }
        spring.stiffness = 1.0 / compliance;
        limb.chain.springs.push_back(spring);
        return limb.chain.springs.size() - 1;
    }

    const Weights &weights_;
};

double deflection(const RestState &rest, std::size_t spring)
{
    return spring == LimbChain::npos ? 0.0 : rest.q[spring];
}

// The moment of all loads beyond a joint about its axis; a rigid joint bears it too.
double moment_n_mm(const LimbChain &limb, const RestState &rest, std::size_t mark)
{
    if (mark == LimbChain::npos) {
        return 0.0;
    }
    const Vector3d joint = rest.placed.weight[mark];
    const Vector3d axis = rest.placed.weight[mark + 1] - joint;
    Vector3d moment = (rest.placed.tip - joint).cross(rest.force_n);
    for (std::size_t m = mark + 2; m < limb.chain.weights.size(); ++m) {
        moment += (rest.placed.weight[m] - joint).cross(limb.chain.weights[m].force_n);
    }
    return axis.dot(moment);
}

const Directions &directions(bool with_coxa)
{
    return with_coxa ? kInSpace : kInPlane;
}

bool yields(const Matrix3d &compliance, int count)
{
    const Vector3d values = spectrum(compliance, count).values;
    return values[0] > kRigid * values[count - 1];
}

// One chain's numbers: all that the extrapolation takes together.
struct Numbers {
    Result result;
    Matrix3d compliance;
    double buckling; // 1 / the factor
};

template <typename Solve>
Outcome solve_one(const LimbChain &limb, const Directions &along_which, Solve solve, Numbers &numbers)
{
    if (!yields(unloaded_compliance(limb.chain, along_which), along_which.count)) {
        return Outcome::rigid;
    }
    RestState rest;
    if (!solve(limb.chain, rest)) {
        return Outcome::no_rest;
    }
    Result &result = numbers.result;
    result.displacement_mm = rest.placed.tip - limb.chain.tip;
    result.force_n = rest.force_n;
    result.k_n_per_mm = inverse(rest.compliance, along_which.count);
    for (int joint = 0; joint < 3; ++joint) {
        result.joint_rad[joint] = deflection(rest, limb.joint[joint]);
        result.joint_n_mm[joint] = moment_n_mm(limb, rest, limb.mark[joint]);
    }
    result.base_x_mm = deflection(rest, limb.base_x);
    result.base_z_mm = deflection(rest, limb.base_z);
    result.base_rad = deflection(rest, limb.base_rotation);
    numbers.compliance = rest.compliance;
    numbers.buckling = 1.0 / rest.buckling_factor;
    return Outcome::found;
}

// The error of a beam of parts is a series in the square of a part's length: its first term is taken out.
template <typename Number> void extrapolate(const Number &coarse, Number &fine)
{
    fine += (fine - coarse) / 3.0;
}

void extrapolate(const Numbers &coarse, bool force_given, int count, Numbers &fine)
{
    extrapolate(coarse.result.displacement_mm, fine.result.displacement_mm);
    extrapolate(coarse.result.force_n, fine.result.force_n);
    extrapolate(coarse.result.joint_rad, fine.result.joint_rad);
    extrapolate(coarse.result.joint_n_mm, fine.result.joint_n_mm);
    extrapolate(coarse.result.base_x_mm, fine.result.base_x_mm);
    extrapolate(coarse.result.base_z_mm, fine.result.base_z_mm);
    extrapolate(coarse.result.base_rad, fine.result.base_rad);
    // What is given has no error: C is then the derivative of the extrapolated displacement, or K of the force.
    if (force_given) {
        extrapolate(coarse.compliance, fine.compliance);
        fine.result.k_n_per_mm = inverse(fine.compliance, count);
    } else {
        extrapolate(coarse.result.k_n_per_mm, fine.result.k_n_per_mm);
    }
    if (coarse.buckling > 0.0 && fine.buckling > 0.0) {
        extrapolate(coarse.buckling, fine.buckling);
    }
}

template <typename Solve>
Outcome solve_limb(const Limb &limb, const Posture &posture, const Weights &weights, bool with_coxa, int parts,
                   bool force_given, Solve solve, Result &result)
{
    const Directions &along_which = directions(with_coxa);
    const auto with_parts = [&](int so_many, Numbers &numbers) {
        return solve_one(chain_of(limb, posture, weights, with_coxa, so_many), along_which, solve, numbers);
    };
    Numbers fine;
    Outcome outcome = with_parts(parts != 0 ? parts : 2 * kParts, fine);
    if (outcome != Outcome::found) {
        return outcome;
    }
    if (parts == 0) {
        Numbers coarse;
        outcome = with_parts(kParts, coarse);
        if (outcome != Outcome::found) {
            return outcome;
        }
        extrapolate(coarse, force_given, along_which.count, fine);
    }
    result = fine.result;
    result.buckling_factor =
        fine.buckling > 1.0 / kNoBuckling ? 1.0 / fine.buckling : std::numeric_limits<double>::infinity();
    return Outcome::found;
}

} // namespace

LimbChain chain_of(const Limb &limb, const Posture &posture, const Weights &weights, bool with_coxa, int parts)
{
    const auto femur_rad = static_cast<double>(posture.theta1_rad);
    const auto tibia_rad = static_cast<double>(posture.theta1_rad - posture.theta2_rad);
    const auto coxa_mm = static_cast<double>(limb.lengths.coxa_mm);
    const auto femur_mm = static_cast<double>(limb.lengths.femur_mm);
    const auto tibia_mm = static_cast<double>(limb.lengths.tibia_mm);
    const Vector3d origin = Vector3d::Zero();
    const Vector3d yaw_axis = {-coxa_mm, 0.0, 0.0};
    const Vector3d knee = femur_mm * along(femur_rad);

    Builder builder(weights);
    LimbChain &made = builder.limb;
    made.base_x = builder.slide({1.0, 0.0, 0.0}, static_cast<double>(limb.base_x_mm_per_n));
    made.base_z = builder.slide({0.0, 0.0, 1.0}, static_cast<double>(limb.base_z_mm_per_n));
    made.base_rotation = builder.hinge(kCounterClockwise, origin, static_cast<double>(limb.base_rotation_rad_per_n_mm));
    if (with_coxa) {
        builder.joint(0, {0.0, 0.0, 1.0}, yaw_axis, static_cast<double>(limb.coxa_joint_rad_per_n_mm));
        builder.link(limb.coxa, yaw_axis, 0.0, coxa_mm, 0.0, parts, true);
    }
    builder.joint(1, kCounterClockwise, origin, static_cast<double>(limb.femur_joint_rad_per_n_mm));
    builder.link(limb.femur, origin, femur_rad, femur_mm, weights.femur_n, parts, with_coxa);
    builder.weight(knee, weights.knee_n);
    builder.joint(2, kCounterClockwise, knee, static_cast<double>(limb.tibia_joint_rad_per_n_mm));
    builder.link(limb.tibia, knee, tibia_rad, tibia_mm, weights.tibia_n, parts, with_coxa);
    made.chain.tip = knee + tibia_mm * along(tibia_rad);
    return made;
}

Outcome under_force(const Limb &limb, const Posture &posture, const Weights &weights, const Vector3d &force_n,
                    bool with_coxa, int parts, Result &result)
{
    const auto solve = [&](const Chain &chain, RestState &rest) {
        return rest_under_force(chain, directions(with_coxa), force_n, rest);
    };
    return solve_limb(limb, posture, weights, with_coxa, parts, true, solve, result);
}

Outcome under_displacement(const Limb &limb, const Posture &posture, const Weights &weights,
                           const Vector3d &displacement_mm, bool with_coxa, int parts, Result &result)
{
    const auto solve = [&](const Chain &chain, RestState &rest) {
        return rest_under_displacement(chain, directions(with_coxa), displacement_mm, rest);
    };
    return solve_limb(limb, posture, weights, with_coxa, parts, false, solve, result);
}

} // namespace brace::reference
