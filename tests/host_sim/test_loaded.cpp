// The loaded limb of the reference against closed forms of beams, finite differences, dense factors, the linear
// reference and the check values of physics.
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "api/checks.h"
#include "reference/loaded.h"

extern "C" {
#include "unity.h"
}

using brace::reference::Chain;
using brace::reference::Loaded;
using brace::reference::Placed;
using brace::reference::Scalars;
using brace::reference::Vector3d;

void setUp(void) {}
void tearDown(void) {}

namespace {

constexpr double kDown_rad = -M_PI / 2.0;
constexpr double kQuarterTurn = M_PI / 2.0;
constexpr int kCoxa = 0, kFemur = 1, kTibia = 2;

brace_plant_model_t paper_limb(double moment_transfer)
{
    brace_plant_model_t limb;
    brace_plant_model_default(&limb);
    limb.geometry.femur_mm = 185.0;
    limb.geometry.tibia_mm = 313.5;
    limb.link[kFemur].axial_mm_per_n = 0.001;
    limb.link[kFemur].bending_mm_per_n = 0.06;
    limb.link[kTibia].axial_mm_per_n = 0.002;
    limb.link[kTibia].bending_mm_per_n = 0.25;
    limb.link[kFemur].moment_transfer = limb.link[kTibia].moment_transfer = moment_transfer;
    limb.joint[kFemur].compliance_rad_per_n_mm = 1.0e-5;
    limb.joint[kTibia].compliance_rad_per_n_mm = 1.6e-5;
    return limb;
}

class Draw {
public:
    explicit Draw(unsigned seed) : generator_(seed) {}
    double between(double low, double high)
    {
        return low + (high - low) * static_cast<double>(generator_()) / 4294967296.0;
    }
    double decade(double low, double high) { return std::pow(10.0, between(low, high)); }

    // Every spring of the limb, tilt and any strength of moment transfer.
    brace_plant_model_t limb()
    {
        brace_plant_model_t limb;
        brace_plant_model_default(&limb);
        limb.geometry = {between(20.0, 100.0), between(80.0, 300.0), between(80.0, 400.0)};
        for (int i = 0; i < 3; ++i) {
            const double strength[] = {0.0, 1.0, between(0.0, 1.0)};
            limb.link[i] = {decade(-4.0, -2.0), decade(-2.5, -0.7), between(-0.4, 0.4),
                            decade(-2.5, -0.7), decade(-7.0, -5.5), strength[generator_() % 3]};
            limb.joint[i].compliance_rad_per_n_mm = decade(-6.0, -4.7);
        }
        limb.base = {decade(-4.0, -2.0), decade(-4.0, -2.0), decade(-7.0, -5.5)};
        limb.gravity = {between(0.0, 3.0), between(0.0, 3.0), between(0.0, 5.0), kDown_rad, 0.0};
        return limb;
    }

private:
    std::mt19937 generator_;
};

brace_loaded_result_t under_force(const brace_plant_model_t &limb, const brace_loaded_case_t &given, int parts = 0)
{
    brace_loaded_result_t result;
    TEST_ASSERT_EQUAL_INT(BRACE_HOST_OK, brace_reference_under_force(&limb, 1, &given, parts, &result, nullptr));
    return result;
}

brace_loaded_result_t under_displacement(const brace_plant_model_t &limb, const brace_loaded_case_t &given,
                                         int parts = 0)
{
    brace_loaded_result_t result;
    TEST_ASSERT_EQUAL_INT(BRACE_HOST_OK, brace_reference_under_displacement(&limb, 1, &given, parts, &result, nullptr));
    return result;
}

brace::reference::Limb reference_limb(const brace_plant_model_t &model)
{
    brace::reference::Limb limb;
    limb.lengths = {model.geometry.coxa_mm, model.geometry.femur_mm, model.geometry.tibia_mm};
    brace::reference::LinkCompliance *const link[] = {&limb.coxa, &limb.femur, &limb.tibia};
    for (int i = 0; i < 3; ++i) {
        const brace_plant_link_t &from = model.link[i];
        *link[i] = {from.axial_mm_per_n,   from.bending_mm_per_n,     from.tilt_rad,
                    from.lateral_mm_per_n, from.torsion_rad_per_n_mm, from.moment_transfer};
    }
    limb.coxa_joint_rad_per_n_mm = model.joint[kCoxa].compliance_rad_per_n_mm;
    limb.femur_joint_rad_per_n_mm = model.joint[kFemur].compliance_rad_per_n_mm;
    limb.tibia_joint_rad_per_n_mm = model.joint[kTibia].compliance_rad_per_n_mm;
    limb.base_x_mm_per_n = model.base.x_mm_per_n;
    limb.base_z_mm_per_n = model.base.z_mm_per_n;
    limb.base_rotation_rad_per_n_mm = model.base.rotation_rad_per_n_mm;
    return limb;
}

// A loaded chain far from rest: what the mechanics say there is judged by differences of the energy.
struct Bent {
    Chain chain;
    Scalars q;
    Vector3d force_n;
    Scalars k;
};

Bent bent_chain(Draw &draw, bool in_space)
{
    const brace_plant_model_t model = draw.limb();
    const Vector3d down = Vector3d(draw.between(-1.0, 1.0), in_space ? 0.4 : 0.0, -1.0).normalized();
    Bent bent;
    bent.chain = chain_of(reference_limb(model), {draw.between(-3.0, 3.0), draw.between(-3.0, 3.0)},
                          {model.gravity.femur_n, model.gravity.tibia_n, model.gravity.knee_n, down}, in_space, 3)
                     .chain;
    for (const auto &spring : bent.chain.springs) {
        bent.k.push_back(spring.stiffness);
        bent.q.push_back(draw.between(-1.0, 1.0) * (spring.hinge ? 0.2 : 5.0));
    }
    bent.force_n = {draw.between(-20.0, 20.0), in_space ? draw.between(-20.0, 20.0) : 0.0, draw.between(-20.0, 20.0)};
    return bent;
}

double energy(const Bent &bent, const Scalars &q)
{
    return energy_n_mm(bent.chain, place(bent.chain, q), q, bent.force_n);
}

Scalars loads(const Bent &bent, const Scalars &q)
{
    return load(bent.chain, place(bent.chain, q), bent.force_n).load;
}

// G from its factors, for i <= j.
double geometric(const Loaded &loaded, std::size_t i, std::size_t j)
{
    return loaded.z[i].dot(loaded.c[j]);
}

// diag(k) - scale G = L L', densely: the rows of L. False: it is not positive definite.
bool cholesky(const Scalars &k, double scale, const Loaded &loaded, std::vector<Scalars> &rows)
{
    rows.assign(k.size(), Scalars(k.size(), 0.0));
    for (std::size_t i = 0; i < k.size(); ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            const double before = std::inner_product(rows[i].begin(), rows[i].begin() + static_cast<std::ptrdiff_t>(j),
                                                     rows[j].begin(), 0.0);
            const double left = (i == j ? k[i] : 0.0) - scale * geometric(loaded, j, i) - before;
            if (i == j && !(left > 0.0)) {
                return false;
            }
            rows[i][j] = i == j ? std::sqrt(left) : left / rows[j][j];
        }
    }
    return true;
}

bool buckles(const Scalars &k, double scale, const Loaded &loaded)
{
    std::vector<Scalars> rows;
    return !cholesky(k, scale, loaded, rows);
}

Eigen::Matrix2d matrix(const brace_loaded_result_t &result)
{
    Eigen::Matrix2d k;
    k << result.k_xx, result.k_xz, result.k_xz, result.k_zz;
    return k;
}

// A straight horizontal limb of which only a beam of the tibia yields: EI = L^3 / (3 b).
struct Cantilever {
    brace_plant_model_t limb;
    double length_mm, ei_n_mm2;
};

Cantilever cantilever()
{
    Cantilever made;
    brace_plant_model_default(&made.limb);
    made.limb.geometry.femur_mm = 100.0;
    made.limb.geometry.tibia_mm = made.length_mm = 300.0;
    brace_plant_link_t &beam = made.limb.link[kTibia];
    beam.bending_mm_per_n = 0.3;
    beam.axial_mm_per_n = 1e-7; // so that C has an inverse
    beam.moment_transfer = 1.0;
    made.ei_n_mm2 = std::pow(made.length_mm, 3) / (3.0 * beam.bending_mm_per_n);
    return made;
}

void test_check_values(void)
{
    // Printed digits of the spec; the beams there are 100 segments with one hinge in the middle of each.
    const struct {
        double moment_transfer, theta1, theta2, fx, fz, dx, dz, k_xx, k_xz, k_zz;
    } line[] = {
        {0.0, 1.0, 1.4, 0.0, 10.0, 3.80735, 31.80811, 4.256242, -0.334349, 0.331800},
        {0.0, 1.0, 1.4, 0.0, -20.0, -13.30591, -56.27056, 3.399383, -1.065312, 0.728438},
        {0.0, 0.3, 0.6, 0.0, 10.0, 5.05100, 40.91618, 18.234468, -1.407903, 0.348259},
        {0.0, 0.3, 0.6, -20.0, 0.0, -4.65112, -16.69184, 12.914473, -2.788440, 0.813156},
        {1.0, 1.0, 1.4, 0.0, 0.0, 0.0, 0.0, 4.672129, -0.758153, 0.395809},
        {1.0, 1.0, 1.4, 0.0, 10.0, 4.23079, 38.12313, 5.091304, -0.306721, 0.272640},
        {1.0, 0.3, 0.6, 0.0, 10.0, 5.72214, 48.83450, 22.428601, -1.369207, 0.283982},
    };
    for (const auto &wanted : line) {
        const auto found = under_force(paper_limb(wanted.moment_transfer),
                                       {wanted.theta1, wanted.theta2, wanted.fx, wanted.fz, 0.0, 0.0, kDown_rad}, -100);
        TEST_ASSERT_DOUBLE_WITHIN(0.51e-5, wanted.dx, found.dx_mm);
        TEST_ASSERT_DOUBLE_WITHIN(0.51e-5, wanted.dz, found.dz_mm);
        TEST_ASSERT_DOUBLE_WITHIN(0.51e-6, wanted.k_xx, found.k_xx);
        TEST_ASSERT_DOUBLE_WITHIN(0.51e-6, wanted.k_xz, found.k_xz);
        TEST_ASSERT_DOUBLE_WITHIN(0.51e-6, wanted.k_zz, found.k_zz);
    }
}

void test_load_is_the_gradient_of_the_energy(void)
{
    Draw draw(1);
    for (int trial = 0; trial < 20; ++trial) {
        const Bent bent = bent_chain(draw, trial % 2 == 1);
        const Scalars load = loads(bent, bent.q);
        for (std::size_t i = 0; i < bent.q.size(); ++i) {
            // The energy's third derivative by a hinge is at most a load's moment, some 1e4 N mm. By a slide it is 0,
            // and rounding of the energy, some 1e5 N mm, is left.
            const bool hinge = bent.chain.springs[i].hinge;
            const double step = hinge ? 1e-4 : 1e-2;
            const double tolerance = hinge ? 1e4 * step * step : 1e-6;
            Scalars q = bent.q;
            q[i] += step;
            const double above = energy(bent, q);
            q[i] -= 2.0 * step;
            const double below = energy(bent, q);
            TEST_ASSERT_DOUBLE_WITHIN(tolerance, bent.k[i] * bent.q[i] - load[i], (above - below) / (2.0 * step));
        }
    }
}

void test_geometric_stiffness_is_the_derivative_of_the_load(void)
{
    Draw draw(2);
    for (int trial = 0; trial < 20; ++trial) {
        const Bent bent = bent_chain(draw, trial % 2 == 1);
        const Loaded loaded = load(bent.chain, place(bent.chain, bent.q), bent.force_n);
        double largest = 0.0, worst = 0.0;
        for (std::size_t j = 0; j < bent.q.size(); ++j) {
            Scalars above = bent.q, below = bent.q;
            above[j] += 1e-5;
            below[j] -= 1e-5;
            const Scalars more = loads(bent, above), less = loads(bent, below);
            for (std::size_t i = 0; i < bent.q.size(); ++i) {
                const double reported = geometric(loaded, std::min(i, j), std::max(i, j));
                largest = std::max(largest, std::fabs(reported));
                worst = std::max(worst, std::fabs((more[i] - less[i]) / 2e-5 - reported));
            }
        }
        TEST_ASSERT_TRUE(worst < 1e-8 * largest);
    }
}

void test_compliance_is_the_derivative_of_the_tip(void)
{
    Draw draw(3);
    for (int trial = 0; trial < 20; ++trial) {
        const brace_plant_model_t limb = draw.limb();
        brace_loaded_case_t given = {draw.between(-3.0, 3.0),
                                     draw.between(-3.0, 3.0),
                                     draw.between(-8.0, 8.0),
                                     draw.between(-8.0, 8.0),
                                     0.0,
                                     0.0,
                                     draw.between(-3.0, 3.0)};
        const auto rest = under_force(limb, given);
        const double step_n = 1e-3;
        Eigen::Matrix2d c;
        for (int axis = 0; axis < 2; ++axis) {
            double &force_n = axis == 0 ? given.fx_n : given.fz_n;
            force_n += step_n;
            const auto above = under_force(limb, given);
            force_n -= 2.0 * step_n;
            const auto below = under_force(limb, given);
            force_n += step_n;
            c.col(axis) << (above.dx_mm - below.dx_mm), (above.dz_mm - below.dz_mm);
        }
        c /= 2.0 * step_n;
        // Rest states are known to 1e-10 mm: 1e-7 mm/N here, beside compliances of 0.01 mm/N and more.
        TEST_ASSERT_TRUE((c - matrix(rest).inverse()).norm() < 1e-6 * c.norm());
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * c.norm(), c(0, 1), c(1, 0));
    }
}

void test_held_tip_gives_the_force_back_and_k_its_derivative(void)
{
    Draw draw(4);
    for (int trial = 0; trial < 20; ++trial) {
        const brace_plant_model_t limb = draw.limb();
        brace_loaded_case_t given = {draw.between(-3.0, 3.0),
                                     draw.between(-3.0, 3.0),
                                     draw.between(-8.0, 8.0),
                                     draw.between(-8.0, 8.0),
                                     0.0,
                                     0.0,
                                     draw.between(-3.0, 3.0)};
        const int parts = 4; // the two directions agree to rounding for one chain
        const auto pushed = under_force(limb, given, parts);
        given.dx_mm = pushed.dx_mm;
        given.dz_mm = pushed.dz_mm;
        const auto held = under_displacement(limb, given, parts);
        const double scale_n = matrix(pushed).norm() * 1e-9;
        TEST_ASSERT_DOUBLE_WITHIN(scale_n, given.fx_n, held.fx_n);
        TEST_ASSERT_DOUBLE_WITHIN(scale_n, given.fz_n, held.fz_n);
        TEST_ASSERT_TRUE((matrix(held) - matrix(pushed)).norm() < 1e-8 * matrix(held).norm());

        Eigen::Matrix2d k;
        const double step_mm = 1e-3;
        for (int axis = 0; axis < 2; ++axis) {
            brace_loaded_case_t beside = given;
            double &moved = axis == 0 ? beside.dx_mm : beside.dz_mm;
            moved += step_mm;
            const auto above = under_displacement(limb, beside);
            moved -= 2.0 * step_mm;
            const auto below = under_displacement(limb, beside);
            k.col(axis) << (above.fx_n - below.fx_n), (above.fz_n - below.fz_n);
        }
        k /= 2.0 * step_mm;
        TEST_ASSERT_TRUE((k - matrix(under_displacement(limb, given))).norm() < 1e-5 * k.norm());
    }
}

void test_no_load_is_the_linear_limb(void)
{
    Draw draw(5);
    for (int trial = 0; trial < 100; ++trial) {
        brace_plant_model_t limb = draw.limb();
        limb.gravity = {};
        const double theta0 = draw.between(-3.0, 3.0), theta1 = draw.between(-3.0, 3.0);
        const double theta2 = draw.between(-3.0, 3.0);
        double row[18];
        TEST_ASSERT_EQUAL_INT(BRACE_HOST_OK, brace_reference_planar(&limb, 1, &theta1, &theta2, row));
        const auto found = under_force(limb, {theta1, theta2, 0.0, 0.0, 0.0, 0.0, kDown_rad}, trial % 5);
        // Rounding of C, and its condition number in K.
        const double tolerance = 1e-14 * row[7] * row[7] / row[6];
        TEST_ASSERT_DOUBLE_WITHIN(tolerance, row[0], found.k_xx);
        TEST_ASSERT_DOUBLE_WITHIN(tolerance, row[1], found.k_xz);
        TEST_ASSERT_DOUBLE_WITHIN(tolerance, row[2], found.k_zz);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, row[8], found.axis_rad);
        TEST_ASSERT_TRUE(found.buckling_factor > std::numeric_limits<double>::max());

        TEST_ASSERT_EQUAL_INT(BRACE_HOST_OK, brace_reference_spatial(&limb, 1, &theta0, &theta1, &theta2, row));
        const brace_loaded_space_case_t given = {theta0, theta1, theta2, 0, 0, 0, 0, 0, 0, 0, 0, -1.0};
        brace_loaded_space_result_t in_space;
        TEST_ASSERT_EQUAL_INT(BRACE_HOST_OK,
                              brace_reference_space_under_force(&limb, 1, &given, trial % 5, &in_space, nullptr));
        const double *const told = &in_space.k_xx;
        for (int i = 0; i < 6; ++i) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-14 * row[14] * row[14] / row[12], row[i], told[i]);
        }
    }
}

void test_plane_and_space_agree_within_the_plane(void)
{
    Draw draw(6);
    for (int trial = 0; trial < 20; ++trial) {
        brace_plant_model_t limb = draw.limb();
        limb.link[kCoxa] = {0.0, 0.0, 0.0, 1e-3, 1e-7, 1.0};
        limb.joint[kCoxa].compliance_rad_per_n_mm = 1e-6;
        const double theta0 = draw.between(-3.0, 3.0), fx = draw.between(-10.0, 10.0), fz = draw.between(-10.0, 10.0);
        const brace_loaded_case_t plane = {0.4, 1.1, fx, fz, 0.0, 0.0, -1.0};
        const auto flat = under_force(limb, plane);
        const brace_loaded_space_case_t given = {theta0,
                                                 0.4,
                                                 1.1,
                                                 fx * std::cos(theta0),
                                                 fx * std::sin(theta0),
                                                 fz,
                                                 0.0,
                                                 0.0,
                                                 0.0,
                                                 std::cos(-1.0) * std::cos(theta0),
                                                 std::cos(-1.0) * std::sin(theta0),
                                                 std::sin(-1.0)};
        brace_loaded_space_result_t found;
        TEST_ASSERT_EQUAL_INT(BRACE_HOST_OK, brace_reference_space_under_force(&limb, 1, &given, 0, &found, nullptr));
        const double size_mm = std::hypot(flat.dx_mm, flat.dz_mm);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * size_mm, flat.dx_mm * std::cos(theta0), found.dx_mm);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * size_mm, flat.dx_mm * std::sin(theta0), found.dy_mm);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * size_mm, flat.dz_mm, found.dz_mm);
        TEST_ASSERT_DOUBLE_WITHIN(1e-8 * flat.k_zz + 1e-9 * flat.lambda_max, flat.k_zz, found.k_zz);
        TEST_ASSERT_DOUBLE_WITHIN(1e-8, flat.tibia_rad, found.tibia_rad);
        TEST_ASSERT_DOUBLE_WITHIN(1e-8 * (1.0 + std::fabs(flat.femur_n_mm)), flat.femur_n_mm, found.femur_n_mm);
    }
}

void test_buckling_factor_and_compliance_by_a_dense_factor(void)
{
    Draw draw(7);
    int buckling = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const bool in_space = trial % 2 == 1;
        const Bent bent = bent_chain(draw, in_space);
        const brace::reference::Directions &directions =
            in_space ? brace::reference::kInSpace : brace::reference::kInPlane;
        brace::reference::RestState rest;
        TEST_ASSERT_TRUE(rest_under_force(bent.chain, directions, bent.force_n, rest));
        // diag(k) - s G is positive definite from s = 0 up to the factor.
        const double factor = rest.buckling_factor;
        if (factor < 1e4) {
            TEST_ASSERT_FALSE(buckles(bent.k, factor * (1.0 - 1e-7), rest.loaded));
            TEST_ASSERT_TRUE(buckles(bent.k, factor * (1.0 + 1e-7), rest.loaded));
            ++buckling;
        } else {
            TEST_ASSERT_FALSE(buckles(bent.k, 1e3, rest.loaded));
        }
        // And C = X' X with L X = J' D.
        std::vector<Scalars> rows;
        TEST_ASSERT_TRUE(cholesky(bent.k, 1.0, rest.loaded, rows));
        std::vector<Vector3d> x(rows.size());
        Eigen::Matrix3d c = Eigen::Matrix3d::Zero();
        for (std::size_t i = 0; i < rows.size(); ++i) {
            x[i] = directions.axes.transpose() * rest.loaded.tip_by_q[i];
            for (std::size_t j = 0; j < i; ++j) {
                x[i] -= rows[i][j] * x[j];
            }
            x[i] /= rows[i][i];
            c += x[i] * x[i].transpose();
        }
        TEST_ASSERT_TRUE((c - rest.compliance).norm() < 1e-9 * c.norm());
    }
    TEST_ASSERT_TRUE(buckling > 20);
}

void test_euler_column(void)
{
    // A straight cantilever pressed along its axis by P buckles at pi^2 EI / (4 L^2).
    const Cantilever beam = cantilever();
    const double critical_n = M_PI * M_PI * beam.ei_n_mm2 / (4.0 * beam.length_mm * beam.length_mm);
    const auto pressed = under_force(beam.limb, {0.3, 0.0, -0.2 * critical_n * std::cos(0.3),
                                                 -0.2 * critical_n * std::sin(0.3), 0.0, 0.0, kDown_rad});
    TEST_ASSERT_DOUBLE_WITHIN(5.0 * 1e-5, 5.0, pressed.buckling_factor);
    const auto pulled = under_force(
        beam.limb, {0.3, 0.0, 0.2 * critical_n * std::cos(0.3), 0.2 * critical_n * std::sin(0.3), 0.0, 0.0, kDown_rad});
    TEST_ASSERT_TRUE(pulled.buckling_factor > 1e3);
}

void test_column_pushed_by_a_held_tip(void)
{
    // With its tip held across, the column stays straight up to 20.19 EI / L^2; then the straight one is no minimum.
    const Cantilever beam = cantilever();
    const double critical_mm = 20.1907 * beam.ei_n_mm2 / (beam.length_mm * beam.length_mm) * 1e-7;
    const brace_loaded_case_t before = {0.0, 0.0, 0.0, 0.0, -0.99 * critical_mm, 0.0, kDown_rad};
    const brace_loaded_case_t beyond = {0.0, 0.0, 0.0, 0.0, -1.01 * critical_mm, 0.0, kDown_rad};
    brace_loaded_result_t result;
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, -0.99 * critical_mm / 1e-7, under_displacement(beam.limb, before).fx_n);
    TEST_ASSERT_EQUAL_INT(BRACE_HOST_E_NO_CONVERGENCE,
                          brace_reference_under_displacement(&beam.limb, 1, &beyond, 0, &result, nullptr));
}

void test_column_under_its_weight(void)
{
    // Greenhill: an upright column buckles where its weight is 7.83735 EI / L^2.
    Cantilever beam = cantilever();
    beam.limb.gravity.tibia_n = 0.25 * 7.837347438943 * beam.ei_n_mm2 / (beam.length_mm * beam.length_mm);
    const auto found = under_force(beam.limb, {kQuarterTurn, 0.0, 0.0, 0.0, 0.0, 0.0, kDown_rad});
    TEST_ASSERT_DOUBLE_WITHIN(4.0 * 2e-5, 4.0, found.buckling_factor);
}

void test_elastica(void)
{
    // Cantilever under an end force P that stays across the undeflected beam (Bisshopp and Drucker 1945): with modulus
    // p of the elliptic integrals and sin(phi) = 1/(p sqrt 2), alpha^2 = P L^2 / EI,
    // alpha = K(p) - F(p, phi), drop = L (1 - 2 (E(p) - E(p, phi)) / alpha), reach = L sqrt(2 (2 p^2 - 1)) / alpha.
    const Cantilever beam = cantilever();
    for (const double modulus : {0.75, 0.8, 0.9}) {
        const double phi = std::asin(1.0 / (modulus * std::sqrt(2.0)));
        const double alpha = std::comp_ellint_1(modulus) - std::ellint_1(modulus, phi);
        const double ends = std::comp_ellint_2(modulus) - std::ellint_2(modulus, phi);
        const double drop_mm = beam.length_mm * (1.0 - 2.0 * ends / alpha);
        const double reach_mm = beam.length_mm * std::sqrt(2.0 * (2.0 * modulus * modulus - 1.0)) / alpha;
        const double force_n = alpha * alpha * beam.ei_n_mm2 / (beam.length_mm * beam.length_mm);
        const auto found = under_force(beam.limb, {0.0, 0.0, 0.0, force_n, 0.0, 0.0, kDown_rad});
        TEST_ASSERT_DOUBLE_WITHIN(3e-6 * beam.length_mm, drop_mm, found.dz_mm);
        TEST_ASSERT_DOUBLE_WITHIN(3e-6 * beam.length_mm, reach_mm - beam.length_mm, found.dx_mm);
    }
}

void test_cantilever_under_its_weight(void)
{
    // W L^3 / (8 EI) = 3/8 b W at the tip of a horizontal beam, for a weight so small that nothing turns.
    Cantilever beam = cantilever();
    const double weight_n = beam.limb.gravity.tibia_n = 1e-3;
    const double beam_mm = 0.375 * 0.3 * weight_n;
    TEST_ASSERT_DOUBLE_WITHIN(1e-6 * beam_mm, -beam_mm,
                              under_force(beam.limb, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, kDown_rad}).dz_mm);
    // An ellipsoid's weight lies before its spring: nothing yields.
    beam.limb.link[kTibia].moment_transfer = 0.0;
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.0, under_force(beam.limb, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, kDown_rad}).dz_mm);
    // Joints and base bear it at mid-length; the knee's weight at the knee.
    beam.limb.gravity = {2e-3, weight_n, 3e-3, kDown_rad, 0.0};
    beam.limb.joint[kFemur].compliance_rad_per_n_mm = 1e-6;
    beam.limb.base.z_mm_per_n = 1e-3;
    const auto found = under_force(beam.limb, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, kDown_rad});
    const double moment_n_mm = -(2e-3 * 50.0 + 3e-3 * 100.0 + weight_n * 250.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, moment_n_mm, found.femur_n_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -weight_n * 150.0, found.tibia_n_mm); // a rigid joint bears it, too
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, moment_n_mm * 1e-6, found.femur_rad);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -6e-3 * 1e-3, found.base_z_mm);
}

void test_default_has_the_accuracy_it_states(void)
{
    Draw draw(8);
    for (int trial = 0; trial < 25; ++trial) {
        const brace_plant_model_t limb = draw.limb();
        const brace_loaded_case_t given = {draw.between(-3.0, 3.0),
                                           draw.between(-3.0, 3.0),
                                           draw.between(-15.0, 15.0),
                                           draw.between(-15.0, 15.0),
                                           0.0,
                                           0.0,
                                           draw.between(-3.0, 3.0)};
        const auto found = under_force(limb, given), fine = under_force(limb, given, 300);
        const double reach_mm = limb.geometry.femur_mm + limb.geometry.tibia_mm;
        if (found.buckling_factor < 2.0 || std::hypot(found.dx_mm, found.dz_mm) > 0.2 * reach_mm) {
            continue;
        }
        // 300 parts are off by less than 0.5 % / 300^2 themselves (two hinges a link are off by up to 0.5 %).
        TEST_ASSERT_TRUE((matrix(found) - matrix(fine)).norm() < 1e-6 * matrix(fine).norm());
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * reach_mm, fine.dx_mm, found.dx_mm);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * reach_mm, fine.dz_mm, found.dz_mm);
        if (fine.buckling_factor < 100.0) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-5 * fine.buckling_factor, fine.buckling_factor, found.buckling_factor);
        }
    }
}

void test_default_in_space_has_it_too(void)
{
    // Turns in space do not commute: a wrong order of a part's hinges leaves an error of first order in its length.
    Draw draw(9);
    int compared = 0;
    for (int trial = 0; trial < 12; ++trial) {
        brace_plant_model_t limb = draw.limb();
        for (auto &link : limb.link) {
            link.moment_transfer = 1.0;
        }
        const brace_loaded_space_case_t given = {draw.between(-3.0, 3.0),
                                                 draw.between(-3.0, 3.0),
                                                 draw.between(-3.0, 3.0),
                                                 draw.between(-12.0, 12.0),
                                                 draw.between(-12.0, 12.0),
                                                 draw.between(-12.0, 12.0),
                                                 0.0,
                                                 0.0,
                                                 0.0,
                                                 0.0,
                                                 0.6,
                                                 -0.8};
        brace_loaded_space_result_t found, fine;
        TEST_ASSERT_EQUAL_INT(BRACE_HOST_OK, brace_reference_space_under_force(&limb, 1, &given, 0, &found, nullptr));
        TEST_ASSERT_EQUAL_INT(BRACE_HOST_OK, brace_reference_space_under_force(&limb, 1, &given, 200, &fine, nullptr));
        const double reach_mm = limb.geometry.femur_mm + limb.geometry.tibia_mm;
        if (found.buckling_factor < 2.0 || std::hypot(found.dx_mm, found.dy_mm, found.dz_mm) > 0.2 * reach_mm) {
            continue;
        }
        ++compared;
        const Eigen::Map<const Eigen::Matrix<double, 6, 1>> told(&found.k_xx), wanted(&fine.k_xx);
        TEST_ASSERT_TRUE((told - wanted).norm() < 1e-6 * wanted.norm());
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * reach_mm, fine.dy_mm, found.dy_mm);
    }
    TEST_ASSERT_TRUE(compared >= 5);
}

void test_rounding_of_places_hides_no_rest(void)
{
    // A stiff limb under its weight moves so little that the last bits of its places outweigh the energy left to gain.
    brace_plant_model_t limb;
    brace_plant_model_default(&limb);
    limb.geometry = {0.0, 89.89509468753252, 199.92700896648523};
    limb.link[kFemur] = {0.00082753, 0.0043064400, -0.3928652262, 0.0, 0.0, 0.9870959704};
    limb.link[kTibia] = {0.00017038, 0.0041380068, 0.0, 0.0, 0.0, 0.3374200361};
    limb.joint[kFemur].compliance_rad_per_n_mm = 2.441358371009306e-06;
    limb.joint[kTibia].compliance_rad_per_n_mm = 2.9572822616473623e-06;
    limb.base = {0.0038752497200238534, 0.0001662239324827258, 8.04209923968022e-07};
    limb.gravity = {2.0, 3.0, 1.0, kDown_rad, 0.0};
    Draw draw(10);
    for (int trial = 0; trial < 3000; ++trial) {
        const brace_loaded_case_t given = {draw.between(-3.0, 3.0),
                                           draw.between(-3.0, 3.0),
                                           draw.between(-4.0, 4.0),
                                           draw.between(-4.0, 4.0),
                                           0.0,
                                           0.0,
                                           draw.between(-3.0, 3.0)};
        under_force(limb, given, 4);
    }
}

void test_refusals(void)
{
    const brace_plant_model_t sound = paper_limb(1.0);
    brace_plant_model_t rigid;
    brace_plant_model_default(&rigid);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const brace_loaded_case_t good = {1.0, 1.4, 0.0, 5.0, 0.0, 0.0, kDown_rad};
    const brace_loaded_case_t bad = {1.0, nan, 0.0, 5.0, 0.0, 0.0, kDown_rad};
    const brace_loaded_case_t cases[] = {good, bad, good};
    brace_loaded_result_t results[3];
    int32_t status[3];
    TEST_ASSERT_EQUAL_INT(BRACE_HOST_E_NOT_FINITE, brace_reference_under_force(&sound, 3, cases, 0, results, status));
    TEST_ASSERT_EQUAL_INT(BRACE_HOST_OK, status[0]);
    TEST_ASSERT_EQUAL_INT(BRACE_HOST_E_NOT_FINITE, status[1]);
    TEST_ASSERT_EQUAL_INT(BRACE_HOST_OK, status[2]);
    TEST_ASSERT_DOUBLE_IS_NAN(results[1].k_xx);
    TEST_ASSERT_DOUBLE_IS_NAN(results[1].base_rad);
    TEST_ASSERT_TRUE(results[2].k_xx > 0.0);
    TEST_ASSERT_EQUAL_INT(BRACE_HOST_E_RANGE, brace_reference_under_force(&sound, 1, &good, 1001, results, status));
    TEST_ASSERT_EQUAL_INT(BRACE_HOST_E_NULL, brace_reference_under_force(&sound, 1, nullptr, 0, results, status));
    TEST_ASSERT_EQUAL_INT(BRACE_HOST_E_SINGULAR, brace_reference_under_force(&rigid, 1, &good, 0, results, status));
    const brace_loaded_space_case_t weightless = {0, 1.0, 1.4, 0, 0, 5.0, 0, 0, 0, 0, 0, 0};
    brace_loaded_space_result_t in_space;
    TEST_ASSERT_EQUAL_INT(BRACE_HOST_E_RANGE,
                          brace_reference_space_under_force(&sound, 1, &weightless, 0, &in_space, nullptr));
}

} // namespace

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_check_values);
    RUN_TEST(test_load_is_the_gradient_of_the_energy);
    RUN_TEST(test_geometric_stiffness_is_the_derivative_of_the_load);
    RUN_TEST(test_compliance_is_the_derivative_of_the_tip);
    RUN_TEST(test_held_tip_gives_the_force_back_and_k_its_derivative);
    RUN_TEST(test_no_load_is_the_linear_limb);
    RUN_TEST(test_plane_and_space_agree_within_the_plane);
    RUN_TEST(test_buckling_factor_and_compliance_by_a_dense_factor);
    RUN_TEST(test_euler_column);
    RUN_TEST(test_column_pushed_by_a_held_tip);
    RUN_TEST(test_column_under_its_weight);
    RUN_TEST(test_elastica);
    RUN_TEST(test_cantilever_under_its_weight);
    RUN_TEST(test_default_has_the_accuracy_it_states);
    RUN_TEST(test_default_in_space_has_it_too);
    RUN_TEST(test_rounding_of_places_hides_no_rest);
    RUN_TEST(test_refusals);
    return UNITY_END();
}
