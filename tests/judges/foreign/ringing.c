/* A limb in its plane on a rig, in time: two joints with inertia that ring after each step of the rig, and friction
 * that bends before it slides.
 *
 * LuGre (Canudas de Wit, Olsson, Astrom, Lischinsky 1995; Dahl's law (1968) without a Stribeck peak), and Maxwell slip
 * (the rate-independent part of Al-Bender, Lampaert, Swevers 2005: equal springs that begin to slide one after
 * another).
 * Each link yields at its end by an ellipsoid that turns with it. The rig holds the tip: it moves within `move_s`, and
 * is read when the joints have had `wait_s` to come to rest. Nothing here is shared with the product's plant, which
 * knows rests only. Units: N, mm, rad, s. */
#include <math.h>
#include <string.h>

enum {
    FEMUR,
    TIBIA,
    AXIAL1,
    BENDING1,
    TILT1,
    AXIAL2,
    BENDING2,
    TILT2,
    BASE_X,
    BASE_Z,
    COMPLIANCE1,
    COMPLIANCE2,
    GAP1,
    GAP2,
    HARDENING1,
    HARDENING2,
    ZERO1,
    ZERO2,
    CHANGE_AT,
    CHANGED_LINK,
    CHANGE,
    WARMTH,
    WARMTH_FROM,
    PLAY,
    INERTIA1,
    INERTIA2,
    DAMPING1,
    DAMPING2,
    LEVEL1,
    LEVEL2,
    MAXWELL,
    BRISTLE_RAD,
    PEAK,
    STRIBECK_RAD_PER_S,
    MOVE_S,
    WAIT_S,
    PARAMETERS
};
enum { RUN, THETA1, THETA2, TIME, TEMP, DX, DZ, COLUMNS };
enum { ELEMENTS = 8 };
/* A limb whose joints stay below this speed for so long, a period of the slowest, is at rest: forces still move by less
 * than a millinewton. */
#define REST_RAD_PER_S 1e-5
#define LOOK_S 0.125

typedef struct {
    double q[2], speed[2], bristle[2], element[2][ELEMENTS];
} state_t;

typedef struct {
    double theta1, theta2, b1, b2, k[2];
} pose_t;

static pose_t pose_of(const double *p, const double *row)
{
    const double changed = row[TIME] >= p[CHANGE_AT] ? p[CHANGE] : 1.0;
    const double warm = 1.0 + p[WARMTH] * (row[TEMP] - p[WARMTH_FROM]);
    pose_t at = {row[THETA1] + p[ZERO1],
                 row[THETA2] + p[ZERO2],
                 p[BENDING1] * (p[CHANGED_LINK] < 0.5 ? changed : 1.0),
                 p[BENDING2] * (p[CHANGED_LINK] > 0.5 ? changed : 1.0),
                 {1.0 / (p[COMPLIANCE1] * warm), 1.0 / (p[COMPLIANCE2] * warm)}};
    return at;
}

/* C of an ellipsoid whose axes stand at an angle: xx, xz, zz. */
static void ellipsoid(double along, double across, double angle, double *c)
{
    const double u = cos(angle), v = sin(angle);
    c[0] = along * u * u + across * v * v;
    c[1] = (along - across) * u * v;
    c[2] = along * v * v + across * u * u;
}

/* The force of the rig on the tip at a place, and its torques about both joints, at deflections q. */
static void held(const double *p, const pose_t *at, const double *q, const double *place, double *force, double *torque)
{
    const double a1 = at->theta1 + q[0], a2 = a1 - at->theta2 - q[1];
    double c1[3], c2[3];
    ellipsoid(p[AXIAL1], at->b1, a1 + p[TILT1], c1);
    ellipsoid(p[AXIAL2], at->b2, a2 + p[TILT2], c2);
    const double xx = c1[0] + c2[0] + p[BASE_X], xz = c1[1] + c2[1], zz = c1[2] + c2[2] + p[BASE_Z];
    const double knee[2] = {p[FEMUR] * cos(a1), p[FEMUR] * sin(a1)};
    const double off[2] = {place[0] - knee[0] - p[TIBIA] * cos(a2), place[1] - knee[1] - p[TIBIA] * sin(a2)};
    const double det = xx * zz - xz * xz;
    force[0] = (zz * off[0] - xz * off[1]) / det;
    force[1] = (xx * off[1] - xz * off[0]) / det;
    const double base[2] = {p[BASE_X] * force[0], p[BASE_Z] * force[1]};
    const double bent[2] = {c1[0] * force[0] + c1[1] * force[1], c1[1] * force[0] + c1[2] * force[1]};
    const double arm1[2] = {place[0] - base[0], place[1] - base[1]};
    const double arm2[2] = {arm1[0] - knee[0] - bent[0], arm1[1] - knee[1] - bent[1]};
    torque[0] = arm1[0] * force[1] - arm1[1] * force[0];
    torque[1] = -(arm2[0] * force[1] - arm2[1] * force[0]);
}

static double spring(const double *p, const pose_t *at, int joint, double q)
{
    const double half = 0.5 * p[GAP1 + joint];
    const double bent = q > half ? q - half : q < -half ? q + half : 0.0;
    return at->k[joint] * bent + p[HARDENING1 + joint] * bent * bent * bent;
}

static double friction(const double *p, state_t *s, int joint, double moved, double dt)
{
    const double level = p[LEVEL1 + joint];
    if (level <= 0.0)
        return 0.0;
    const double bristle = level / p[BRISTLE_RAD];
    if (p[MAXWELL] > 0.0) {
        double sum = 0.0;
        for (int i = 0; i < ELEMENTS; i++) {
            const double most = level * 2.0 * (i + 1) / (ELEMENTS * (ELEMENTS + 1.0));
            const double bent = s->element[joint][i] + bristle * 2.0 / (ELEMENTS + 1.0) * moved;
            s->element[joint][i] = fmax(-most, fmin(most, bent));
            sum += s->element[joint][i];
        }
        return sum;
    }
    const double ratio = moved / dt / p[STRIBECK_RAD_PER_S];
    const double most = p[BRISTLE_RAD] * (1.0 + p[PEAK] * exp(-ratio * ratio));
    s->bristle[joint] = (s->bristle[joint] + moved) / (1.0 + fabs(moved) / most);
    return bristle * s->bristle[joint];
}

static void step(const double *p, const pose_t *at, state_t *s, const double *place, double dt, double *force)
{
    double torque[2];
    held(p, at, s->q, place, force, torque);
    for (int joint = 0; joint < 2; joint++) {
        const double moved = s->speed[joint] * dt;
        const double rubbed = friction(p, s, joint, moved, dt);
        const double left = torque[joint] - spring(p, at, joint, s->q[joint]) - rubbed;
        s->speed[joint] = (s->speed[joint] + dt * left / p[INERTIA1 + joint]) /
                          (1.0 + dt * p[DAMPING1 + joint] / p[INERTIA1 + joint]);
        s->q[joint] += s->speed[joint] * dt;
    }
}

/* Rows of COLUMNS numbers; out: fx, fz a row. */
void ringing_play(const double *p, const double *rows, int count, double dt, double *out)
{
    state_t s;
    double tip[2] = {0.0, 0.0};
    for (int i = 0; i < count; i++) {
        const double *row = rows + (long)i * COLUMNS;
        const pose_t at = pose_of(p, row);
        const double zero[2] = {p[FEMUR] * cos(at.theta1) + p[TIBIA] * cos(at.theta1 - at.theta2),
                                p[FEMUR] * sin(at.theta1) + p[TIBIA] * sin(at.theta1 - at.theta2)};
        if (i == 0 || row[RUN] != row[RUN - COLUMNS]) {
            memset(&s, 0, sizeof s);
            tip[0] = tip[1] = 0.0;
        }
        double to[2];
        for (int axis = 0; axis < 2; axis++) {
            const double half = 0.5 * p[PLAY], asked = row[DX + axis];
            to[axis] = fmax(asked - half, fmin(asked + half, tip[axis]));
        }
        double *force = out + 2L * i;
        const int moving = (int)(p[MOVE_S] / dt), all = moving + (int)(p[WAIT_S] / dt), look = (int)(LOOK_S / dt);
        double fastest = 0.0;
        for (int n = 1; n <= all; n++) {
            const double share = n < moving ? (double)n / moving : 1.0;
            const double place[2] = {zero[0] + tip[0] + share * (to[0] - tip[0]),
                                     zero[1] + tip[1] + share * (to[1] - tip[1])};
            step(p, &at, &s, place, dt, force);
            fastest = fmax(fastest, fmax(fabs(s.speed[0]), fabs(s.speed[1])));
            if (n > moving && (n - moving) % look == 0) {
                if (fastest < REST_RAD_PER_S)
                    break;
                fastest = 0.0;
            }
        }
        tip[0] = to[0];
        tip[1] = to[1];
    }
}
