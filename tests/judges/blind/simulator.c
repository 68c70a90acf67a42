/* Quasi-static loading tests on a limb in its plane: the blind benchmark's own plant, written from the physics
 * alone and sharing nothing with the product's. Tip displacement is imposed, force is read.
 * Units: mm, N, N mm, rad, s, degC.
 *
 * Each row is a convex problem in the two joint deflections q: elastic links and base between tip and joints,
 *     b_j - sum_k A_jk q_k  in  T_j(q_j - creep_j) + coulomb_j * sign(q_j - q_j before)
 * with A = P' K P, b = P' K d + gravity. It is solved by nesting: joint 2 in closed form for a given joint 1 (but for
 * a cubic), joint 1 by Newton steps kept inside a bracket. */
#include <math.h>

// clang-format off
enum parameter { /* the order of plant.py's KEYS */
    FEMUR, TIBIA,
    AXIAL1, BENDING1, TILT1, TRANSFER1, AXIAL2, BENDING2, TILT2,
    COMPLIANCE1, COMPLIANCE2, GAP1, GAP2, COULOMB1, COULOMB2, HARDENING1, HARDENING2, OFFSET1, OFFSET2,
    BASE_X, BASE_Z, BASE_ROTATION,
    WEIGHT_FEMUR, WEIGHT_TIBIA, WEIGHT_KNEE,
    BIAS_X, BIAS_Z, GAIN, ROTATION, CROSSTALK_XZ, CROSSTALK_ZX, DRIFT_X, DRIFT_Z, SATURATION,
    CREEP_RATIO, CREEP_TIME, THERMAL, REFERENCE, PLAY, CHANGE_AT, CHANGE_LINK, CHANGE_FACTOR,
    /* what no key of limb.toml describes */
    ASYMMETRY,       /* share by which a joint is more compliant when pushed counter-clockwise */
    GAP_OFFSET,      /* play's centre away from rest, in units of half the gap */
    GAP_GROWTH,      /* rad/s by which both joints' play grows */
    COGGING, COGGING_PERIOD,   /* torque ripple [N mm] over the joint's deflection [rad] */
    PARAMETERS
};
// clang-format on

typedef struct {
    double stiffness, hardening, half_gap, gap_centre, coulomb, asymmetry, cogging, period;
    double before, crept; /* deflection at the row before; delayed part of it [rad] */
} Joint;

static double torque(const Joint *j, double e, double *slope)
{
    double x, t, s;
    double c = e - j->gap_centre;
    if (fabs(c) <= j->half_gap) {
        t = 0.0;
        s = 0.0;
    } else {
        double k = c > 0.0 ? j->stiffness / (1.0 + j->asymmetry) : j->stiffness;
        x = c > 0.0 ? c - j->half_gap : c + j->half_gap;
        t = k * x + j->hardening * x * x * x;
        s = k + 3.0 * j->hardening * x * x;
    }
    if (j->cogging != 0.0) {
        t += j->cogging * sin(2.0 * M_PI * e / j->period);
        s += j->cogging * 2.0 * M_PI / j->period * cos(2.0 * M_PI * e / j->period);
    }
    *slope = s;
    return t;
}

/* Root of the decreasing function load - stiffness_of_rest * q - torque(q - crept), stuck where friction holds.
 * *yield becomes dq/dload. */
static double settle_one(const Joint *j, double load, double rest, double *yield)
{
    double slope, held = load - rest * j->before - torque(j, j->before - j->crept, &slope);
    double drive, q, low, high;
    if (fabs(held) <= j->coulomb && j->coulomb > 0.0) {
        *yield = 0.0;
        return j->before;
    }
    drive = load - (held > 0.0 ? j->coulomb : -j->coulomb);
    q = (drive + j->stiffness * j->crept) / (rest + j->stiffness);
    low = -1e30;
    high = 1e30;
    for (int i = 0; i < 200; ++i) {
        double f = drive - rest * q - torque(j, q - j->crept, &slope), step, next;
        if (f > 0.0)
            low = q;
        else
            high = q;
        if (f == 0.0)
            break;
        step = f / (rest + slope);
        next = q + step;
        if (!(next > low && next < high) && low > -1e29 && high < 1e29)
            next = 0.5 * (low + high);
        if (fabs(next - q) <= 1e-16 * (1e-3 + fabs(q))) {
            q = next;
            break;
        }
        q = next;
    }
    torque(j, q - j->crept, &slope);
    *yield = 1.0 / (rest + slope);
    return q;
}

static void settle(const Joint j[2], const double a[3], const double b[2], double q[2])
{
    double yield, slope, q1 = j[0].before, low = -1e30, high = 1e30, drive, held;
    double q2 = settle_one(&j[1], b[1] - a[1] * q1, a[2], &yield);
    held = b[0] - a[0] * q1 - a[1] * q2 - torque(&j[0], q1 - j[0].crept, &slope);
    if (fabs(held) <= j[0].coulomb && j[0].coulomb > 0.0) {
        q[0] = q1;
        q[1] = q2;
        return;
    }
    drive = b[0] - (held > 0.0 ? j[0].coulomb : -j[0].coulomb);
    for (int i = 0; i < 200; ++i) {
        double f, next;
        q2 = settle_one(&j[1], b[1] - a[1] * q1, a[2], &yield);
        f = drive - a[0] * q1 - a[1] * q2 - torque(&j[0], q1 - j[0].crept, &slope);
        if (f > 0.0)
            low = q1;
        else
            high = q1;
        if (f == 0.0)
            break;
        next = q1 + f / (a[0] - a[1] * a[1] * yield + slope);
        if (!(next > low && next < high) && low > -1e29 && high < 1e29)
            next = 0.5 * (low + high);
        if (fabs(next - q1) <= 1e-16 * (1e-3 + fabs(q1))) {
            q1 = next;
            break;
        }
        q1 = next;
    }
    q[0] = q1;
    q[1] = settle_one(&j[1], b[1] - a[1] * q1, a[2], &yield);
}

static void add(double c[3], double s, double x, double z)
{
    c[0] += s * x * x;
    c[1] += s * x * z;
    c[2] += s * z * z;
}

static double play_operator(double was, double imposed, double half)
{
    if (imposed - was > half)
        return imposed - half;
    if (was - imposed > half)
        return imposed + half;
    return was;
}

/* rows: run,theta1,theta2,t,temp,dx,dz (7 doubles each); out: fx,fz,enc1,enc2,base_x,base_z (6 doubles each).
 * Forces are readings before noise and rounding. */
void blind_play(const double *p, const double *rows, int count, double *out)
{
    Joint j[2] = {{0}};
    double tip[2] = {0, 0}, crept[2] = {0, 0}, elastic[2] = {0, 0};
    double run = -1e300, t_before = 0.0;
    const double cr = cos(p[ROTATION]), sr = sin(p[ROTATION]);

    for (int i = 0; i < count; ++i) {
        const double *row = rows + 7 * i;
        double *o = out + 6 * i;
        const double t = row[3], th1 = row[1] + p[OFFSET1], th2 = row[2] + p[OFFSET2];
        const double first = row[0] != run;
        const double L1 = p[FEMUR], L2 = p[TIBIA];
        const double soft = 1.0 + p[THERMAL] * (row[4] - p[REFERENCE]);
        const double changed = t >= p[CHANGE_AT] ? p[CHANGE_FACTOR] : 1.0;
        const double b1 = p[BENDING1] * (p[CHANGE_LINK] < 0.5 ? changed : 1.0);
        const double b2 = p[BENDING2] * (p[CHANGE_LINK] > 0.5 ? changed : 1.0);
        double q[2] = {0, 0}, f[2] = {0, 0};

        for (int n = 0; n < 2; ++n) {
            const double gap = fmax(0.0, p[GAP1 + n] + p[GAP_GROWTH] * t);
            j[n].stiffness = 1.0 / (p[COMPLIANCE1 + n] * soft);
            j[n].hardening = p[HARDENING1 + n];
            j[n].half_gap = 0.5 * gap;
            j[n].gap_centre = 0.5 * gap * p[GAP_OFFSET];
            j[n].coulomb = p[COULOMB1 + n];
            j[n].asymmetry = p[ASYMMETRY];
            j[n].cogging = p[COGGING];
            j[n].period = p[COGGING_PERIOD];
        }
        if (first) {
            run = row[0];
            tip[0] = tip[1] = 0.0;
            for (int n = 0; n < 2; ++n)
                crept[n] = elastic[n] = j[n].before = 0.0;
            t_before = t;
        }
        tip[0] = play_operator(tip[0], row[5], 0.5 * p[PLAY]);
        tip[1] = play_operator(tip[1], row[6], 0.5 * p[PLAY]);
        {
            const double grow = 1.0 - exp(-(t - t_before) / p[CREEP_TIME]);
            for (int n = 0; n < 2; ++n) {
                crept[n] += grow * (p[CREEP_RATIO] * elastic[n] - crept[n]);
                j[n].crept = crept[n];
            }
            t_before = t;
        }
        {
            const double g1 = th1, g2 = th1 - th2;
            const double ux = cos(g1), uz = sin(g1), vx = cos(g2), vz = sin(g2);
            const double wx = L2 * vx, wz = L2 * vz, px = L1 * ux + wx, pz = L1 * uz + wz;
            const double P1[2] = {-pz, px}, P2[2] = {-wz, wx};
            const double e1 = g1 + p[TILT1], e2 = g2 + p[TILT2];
            double c[3] = {p[BASE_X], 0.0, p[BASE_Z]}, k[3], det, a[3], b[2], load[2];

            add(c, p[AXIAL1], cos(e1), sin(e1));
            add(c, b1, -sin(e1), cos(e1));
            add(c, p[AXIAL2], cos(e2), sin(e2));
            add(c, b2, -sin(e2), cos(e2));
            add(c, p[BASE_ROTATION], P1[0], P1[1]);
            if (p[TRANSFER1] != 0.0) {
                const double s = p[TRANSFER1] * 1.5 * b1 / L1, nx = -sin(e1), nz = cos(e1);
                c[0] += s * 2.0 * nx * P2[0];
                c[1] += s * (nx * P2[1] + nz * P2[0]);
                c[2] += s * 2.0 * nz * P2[1];
                add(c, p[TRANSFER1] * 3.0 * b1 / (L1 * L1), P2[0], P2[1]);
            }
            det = c[0] * c[2] - c[1] * c[1];
            k[0] = c[2] / det;
            k[1] = -c[1] / det;
            k[2] = c[0] / det;
            load[0] =
                -(p[WEIGHT_FEMUR] * 0.5 * L1 * ux + p[WEIGHT_KNEE] * L1 * ux + p[WEIGHT_TIBIA] * (L1 * ux + 0.5 * wx));
            load[1] = -p[WEIGHT_TIBIA] * 0.5 * wx;
            a[0] = P1[0] * (k[0] * P1[0] + k[1] * P1[1]) + P1[1] * (k[1] * P1[0] + k[2] * P1[1]);
            a[1] = P1[0] * (k[0] * P2[0] + k[1] * P2[1]) + P1[1] * (k[1] * P2[0] + k[2] * P2[1]);
            a[2] = P2[0] * (k[0] * P2[0] + k[1] * P2[1]) + P2[1] * (k[1] * P2[0] + k[2] * P2[1]);
            f[0] = k[0] * tip[0] + k[1] * tip[1];
            f[1] = k[1] * tip[0] + k[2] * tip[1];
            b[0] = P1[0] * f[0] + P1[1] * f[1] + load[0];
            b[1] = P2[0] * f[0] + P2[1] * f[1] + load[1];
            if (first) { /* rested: where the joints settle without friction */
                Joint free[2] = {j[0], j[1]};
                free[0].coulomb = free[1].coulomb = 0.0;
                settle(free, a, b, q);
                j[0].before = q[0];
                j[1].before = q[1];
            }
            settle(j, a, b, q);
            {
                const double dx = tip[0] - P1[0] * q[0] - P2[0] * q[1], dz = tip[1] - P1[1] * q[0] - P2[1] * q[1];
                f[0] = k[0] * dx + k[1] * dz;
                f[1] = k[1] * dx + k[2] * dz;
            }
        }
        for (int n = 0; n < 2; ++n) {
            j[n].before = q[n];
            elastic[n] = q[n] - j[n].crept;
        }
        {
            const double sx = f[0] + p[CROSSTALK_XZ] * f[1], sz = p[CROSSTALK_ZX] * f[0] + f[1];
            const double limit = p[SATURATION];
            double x = p[BIAS_X] + p[DRIFT_X] * t + p[GAIN] * (cr * sx - sr * sz);
            double z = p[BIAS_Z] + p[DRIFT_Z] * t + p[GAIN] * (sr * sx + cr * sz);
            o[0] = fmin(limit, fmax(-limit, x));
            o[1] = fmin(limit, fmax(-limit, z));
        }
        o[2] = q[0];
        o[3] = q[1];
        o[4] = p[BASE_X] * f[0];
        o[5] = p[BASE_Z] * f[1];
    }
}
