/* One joint on a bench, in time: a motor's inertia, a spring beyond play, and friction of three laws of the literature.
 *
 * LuGre (Canudas de Wit et al. 1995; Dahl's is the case without a Stribeck peak and without damping of the
 * bristles) and generalised Maxwell slip (Al-Bender et al. 2005, its rate-independent part), both with a level that
 * grows with the spring's torque; a slider behind free travel, for dampers. Units: N mm, rad, s. */
#include <math.h>

enum {
    STIFFNESS,
    GAP,
    ZERO,
    HARDENING,
    SOFT_AT,
    ONE_SIDED,
    STOP_AT,
    STOP,
    CREEP,
    CREEP_S,
    COGGING,
    COGGING_PERIOD,
    COGGING_PHASE,
    VISCOUS,
    INERTIA,
    COULOMB,
    PER_LOAD,
    BRISTLE,
    BRISTLE_DAMPING,
    PEAK,
    STRIBECK,
    SLIP,
    SLIP_TORQUE,
    SLIP_STIFFNESS,
    MAXWELL, /* 0: LuGre */
    PARAMETERS
};
enum { ANGLE, SPEED, BRISTLE_BENT, SLIDER, CREPT, LATEST, ELEMENTS = 8, STATE = LATEST + 1 + ELEMENTS };

static double beyond(double x, double half)
{
    return x > half ? x - half : x < -half ? x + half : 0.0;
}

static double spring(const double *p, const double *s, double angle, double *elastic)
{
    double bent = beyond(angle - p[ZERO], 0.5 * p[GAP]) - s[CREPT];
    double k = p[STIFFNESS] * (bent > 0.0 ? 1.0 + p[ONE_SIDED] : 1.0);
    double torque = k * bent + p[HARDENING] * bent * bent * bent;
    if (p[SOFT_AT] > 0.0)
        torque = k * bent / sqrt(1.0 + (bent / p[SOFT_AT]) * (bent / p[SOFT_AT]));
    if (p[STOP] > 0.0 && bent > p[STOP_AT])
        torque += p[STOP] * (bent - p[STOP_AT]);
    *elastic = bent;
    return torque;
}

static double friction(const double *p, double *s, double moved, double dt, double load)
{
    double level = p[COULOMB] + p[PER_LOAD] * fabs(load), speed = moved / dt, torque = 0.0;
    if (level > 0.0 && p[MAXWELL] > 0.0) {
        /* Elements of equal stiffness that begin to slip one after another, up to the bristles' length. */
        for (int i = 0; i < ELEMENTS; i++) {
            double most = level * 2.0 * (i + 1) / (ELEMENTS * (ELEMENTS + 1.0));
            double *w = &s[LATEST + 1 + i];
            *w += p[BRISTLE] * 2.0 / (ELEMENTS + 1.0) * moved;
            *w = fmax(-most, fmin(most, *w));
            torque += *w;
        }
    } else if (level > 0.0) {
        double ratio = speed / p[STRIBECK], before = s[BRISTLE_BENT];
        double g = level * (1.0 + p[PEAK] * exp(-ratio * ratio)) / p[BRISTLE];
        s[BRISTLE_BENT] = (before + moved) / (1.0 + fabs(moved) / g);
        torque = p[BRISTLE] * s[BRISTLE_BENT] + p[BRISTLE_DAMPING] * (s[BRISTLE_BENT] - before) / dt;
    }
    if (p[SLIP_TORQUE] > 0.0) {
        double most = p[SLIP_TORQUE] / p[SLIP_STIFFNESS], angle = s[ANGLE] - p[ZERO];
        double bent = beyond(angle - s[SLIDER], 0.5 * p[SLIP]);
        if (bent > most)
            s[SLIDER] += bent - most;
        if (bent < -most)
            s[SLIDER] += bent + most;
        torque += p[SLIP_STIFFNESS] * beyond(angle - s[SLIDER], 0.5 * p[SLIP]);
    }
    return torque + p[VISCOUS] * speed;
}

/* command: torque or angle at `rows` readings `interval` apart, between them along straight lines. */
void actuator_play(const double *p, double *s, const double *command, int rows, double interval, int substeps,
                   int torque_driven, double *angle, double *torque)
{
    double dt = interval / substeps, sum = 0.0;
    for (int row = 0; row < rows; row++) {
        int many = row ? substeps : 1;
        for (int k = 1; k <= many; k++) {
            double now = row ? command[row - 1] + (command[row] - command[row - 1]) * k / many : command[0];
            double elastic, moved, speed, before = s[ANGLE];
            if (torque_driven) {
                double load = spring(p, s, before, &elastic);
                double ripple = p[COGGING] * sin(6.283185307179586 * before / p[COGGING_PERIOD] + p[COGGING_PHASE]);
                s[SPEED] += dt * (now - load - ripple - s[LATEST]) / p[INERTIA];
                moved = s[SPEED] * dt;
                s[ANGLE] = before + moved;
                s[LATEST] = friction(p, s, moved, dt, load);
                sum = now;
            } else {
                s[ANGLE] = now;
                moved = now - before;
                speed = moved / dt;
                double load = spring(p, s, now, &elastic);
                double ripple = p[COGGING] * sin(6.283185307179586 * now / p[COGGING_PERIOD] + p[COGGING_PHASE]);
                s[LATEST] = friction(p, s, moved, dt, load);
                /* The start of a test is no blow: the first reading has no speed before it. */
                sum = load + ripple + s[LATEST] + (row ? p[INERTIA] * (speed - s[SPEED]) / interval : 0.0);
                if (k == many)
                    s[SPEED] = speed;
            }
            if (p[CREEP] > 0.0)
                s[CREPT] += dt / p[CREEP_S] * (p[CREEP] * elastic - s[CREPT]);
        }
        angle[row] = s[ANGLE];
        torque[row] = sum;
    }
}
