// K under a load with Eigen's fixed-size matrices: two steps of Newton's method on the energy from the straight limb,
// with the same unknowns, sums and buckling search as CasADi's; gradients and Hessian written by hand.
#include "bench_data.h"
extern "C" {
#include "job.h"
#include "loaded_case.h"
}

#include <Eigen/Dense>

#include <cmath>

namespace {

using Eigen::Matrix2f;
using Eigen::Rotation2Df;
using Eigen::Vector2f;
using Matrix6f = Eigen::Matrix<float, 6, 6>;
using Vector6f = Eigen::Matrix<float, 6, 1>;
using Levers = Eigen::Matrix<float, 2, 6>;
using Vector3f = Eigen::Vector3f;

const brace_limb_t limb = BENCH_LIMB;
const float postures[BENCH_ALL_COUNT][3] = BENCH_ALL;

// Turn at three Gauss points of a beam by its root and its two curvatures, and the points' shares.
const float place[3] = {0.112701665f, 0.5f, 0.887298335f};
const float share[3] = {0.277777778f, 0.444444444f, 0.277777778f};
const Vector3f turn_by[3] = {
    {1.0f, 0.285906746f, -0.0605034154f}, {1.0f, 0.933012702f, 0.0669872981f}, {1.0f, 1.06050342f, 0.714093254f}};

Vector2f turned(const Vector2f &v)
{
    return {-v.y(), v.x()};
}

Vector2f along(float angle)
{
    return Rotation2Df(angle) * Vector2f::UnitX();
}

// A link at a shape: its end, what its loads drive (times the load, and its square), and how it moves the tip.
struct Bent {
    Vector2f end = Vector2f::Zero();
    Vector3f drives = Vector3f::Zero();
    Eigen::Matrix3f resists = Eigen::Matrix3f::Zero(), softens = Eigen::Matrix3f::Zero();
    Eigen::Matrix<float, 2, 3> levers = Eigen::Matrix<float, 2, 3>::Zero();
    Matrix2f springs = Matrix2f::Zero();

    void lever(const Vector2f &r, const Vector2f &force, const Vector3f &by)
    {
        end += r;
        drives += turned(r).dot(force) * by;
        resists += r.dot(force) * by * by.transpose();
        levers += turned(r) * by.transpose();
    }

    void spring(float yields, const Vector2f &axis, const Vector2f &force, const Vector3f &by)
    {
        const float p = axis.dot(force), q = turned(axis).dot(force);
        end += yields * p * axis;
        drives += yields * p * q * by;
        resists += yields * p * p * by * by.transpose();
        softens += yields * q * q * by * by.transpose();
        levers += yields * (p * turned(axis) + q * axis) * by.transpose();
        springs += yields * axis * axis.transpose();
    }
};

Bent bend(const brace_link_t &link, float length, float angle, const Vector3f &q, const Vector2f &beyond,
          const Vector2f &own)
{
    Bent bent;
    const Vector3f root = Vector3f::UnitX(), tip = Vector3f::Ones();
    const float strength = link.moment_transfer, rooted = angle + link.tilt_rad + q[0];
    bent.lever(length * (along(angle + q[0]) - along(rooted)), beyond + 0.5f * own, root);
    for (int i = 0; i < 3; i++) {
        bent.lever(share[i] * length * along(rooted + turn_by[i].tail<2>().dot(q.tail<2>())),
                   beyond + (1.0f - place[i]) * own, turn_by[i]);
    }
    const Vector2f end = along(rooted + q[1] + q[2]);
    bent.spring(strength * link.axial_mm_per_n, along(rooted), beyond + own, root);
    bent.spring((1.0f - strength) * link.axial_mm_per_n, end, beyond, tip);
    bent.spring((1.0f - strength) * link.bending_mm_per_n, turned(end), beyond, tip);
    return bent;
}

struct State {
    Bent femur, tibia;

    Matrix6f loaded(const Matrix6f &stiffness, float times) const
    {
        Matrix6f h = stiffness;
        h.topLeftCorner<3, 3>() += times * femur.resists - times * times * femur.softens;
        h.bottomRightCorner<3, 3>() += times * tibia.resists - times * times * tibia.softens;
        return h;
    }
};

State state_at(const float *theta, const Vector6f &q, const Vector2f &force)
{
    const Vector2f down(0.0f, -1.0f);
    return {bend(limb.link[BRACE_FEMUR], limb.femur_mm, theta[1], q.head<3>(),
                 force + (BENCH_TIBIA_N + BENCH_KNEE_N) * down, BENCH_FEMUR_N * down),
            bend(limb.link[BRACE_TIBIA], limb.tibia_mm, theta[1] - theta[2], q.tail<3>(), force, BENCH_TIBIA_N * down)};
}

Matrix6f springs()
{
    Vector6f knee;
    knee << -1.0f, -1.0f, -1.0f, 1.0f, 0.0f, 0.0f;
    Matrix6f k = knee * knee.transpose() / limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm;
    k(0, 0) += 1.0f / (limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm + limb.base.rotation_rad_per_n_mm);
    for (int i = 0; i < 2; i++) {
        const brace_link_t &link = limb.link[BRACE_FEMUR + i];
        const float length = i == 0 ? limb.femur_mm : limb.tibia_mm;
        const float yields = 1.5f * link.moment_transfer * link.bending_mm_per_n / (length * length);
        k(3 * i + 1, 3 * i + 1) += 1.0f / yields;
        k(3 * i + 2, 3 * i + 2) += 1.0f / yields;
    }
    return k;
}

float buckling(const Matrix6f &k, const State &state)
{
    const float unloaded = k.determinant(), ratio[3] = {4.0f, 2.0f, 1.41421356f};
    float before = 0.0f, low = 1.0f, high = 16.0f;
    float at_before = 1.0f, at_low = state.loaded(k, 1.0f).determinant() / unloaded, at_high = 0.0f;
    for (int i = 0; i < 3; i++) {
        const float middle = low * ratio[i];
        const Eigen::LDLT<Matrix6f> factors(state.loaded(k, middle));
        const float now = factors.vectorD().prod() / unloaded;
        if (factors.isPositive()) {
            before = low, at_before = at_low;
            low = middle, at_low = now;
        } else {
            high = middle, at_high = now;
        }
    }
    if (!(at_high < 0.0f)) {
        return INFINITY;
    }
    const float chord = (at_high - at_low) / (high - low), root = low - at_low / chord;
    const float bow = ((at_before - at_low) / (before - low) - chord) / (before - high);
    return root - bow * (root - low) * (root - high) / (chord + bow * ((root - low) + (root - high)));
}

} // namespace

extern "C" {
extern const int job_runs = BENCH_ALL_COUNT;
extern const int job_out_count = 9;

void job_setup(void) {}

__attribute__((noinline)) void eigen_loaded(const float *theta, const float *force_n, float *out)
{
    const Vector2f force(force_n[0], force_n[1]);
    const Matrix6f k0 = springs();
    Vector6f q = Vector6f::Zero();
    for (int i = 0; i < 2; i++) {
        const State state = state_at(theta, q, force);
        Vector6f drives;
        drives << state.femur.drives, state.tibia.drives;
        q += state.loaded(k0, 1.0f).ldlt().solve(drives - k0 * q);
    }
    const State state = state_at(theta, q, force);
    Levers levers;
    levers << state.femur.levers, state.tibia.levers;
    Matrix2f c = levers * state.loaded(k0, 1.0f).ldlt().solve(levers.transpose());
    c += state.femur.springs + state.tibia.springs;
    c(0, 0) += limb.base.x_mm_per_n;
    c(1, 1) += limb.base.z_mm_per_n;
    const Matrix2f k = c.inverse();
    Eigen::SelfAdjointEigenSolver<Matrix2f> solver;
    solver.computeDirect(k);
    const Vector2f stiff = solver.eigenvectors().col(1);
    const Vector2f on_base = force - (BENCH_FEMUR_N + BENCH_KNEE_N + BENCH_TIBIA_N) * Vector2f::UnitY();
    const Vector2f moved = state.femur.end + state.tibia.end - limb.femur_mm * along(theta[1]) -
                           limb.tibia_mm * along(theta[1] - theta[2]) +
                           Vector2f(limb.base.x_mm_per_n * on_base.x(), limb.base.z_mm_per_n * on_base.y());
    const float numbers[9] = {k(0, 0),
                              k(0, 1),
                              k(1, 1),
                              solver.eigenvalues()(0),
                              solver.eigenvalues()(1),
                              std::atan2(stiff.y(), stiff.x()),
                              moved.x(),
                              moved.y(),
                              buckling(k0, state)};
    for (int i = 0; i < 9; i++) {
        out[i] = numbers[i];
    }
}

void job_run(int index, float *out)
{
    float force[2];
    load_of(index, force);
    eigen_loaded(postures[index], force, out);
}
}
