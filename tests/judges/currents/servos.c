#include "servos.h"

#include <math.h>

const fit_t mx106_m5 = {.kt = 2.2087822411811935,
                        .r = 2.0142427292798475,
                        .armature = 0.026018155628771758,
                        .base = 0.0,
                        .base_stribeck = 0.12242747179820507,
                        .motor = 0.20763710226562626,
                        .motor_stribeck = 0.19519320110890795,
                        .outside = 0.022684350817709906,
                        .outside_stribeck = 0.08490162305974122,
                        .stribeck_rad_per_s = 1.7457130513692263,
                        .alpha = 1.138313248724122,
                        .viscous = 0.05066487276724427};

const fit_t mx106_m6 = {.kt = 2.209828156174588,
                        .r = 2.033661749312417,
                        .armature = 0.026016184370993383,
                        .base = 1.0232526438525893e-05,
                        .base_stribeck = 0.12195409579603411,
                        .motor = 0.19800553725822115,
                        .motor_stribeck = 0.19859970173941574,
                        .motor_quad = 0.009999930103371748,
                        .outside = 0.022215529897348624,
                        .outside_stribeck = 0.08710328264676681,
                        .outside_quad = 7.326919843140997e-05,
                        .stribeck_rad_per_s = 1.7463251741328727,
                        .alpha = 1.142827788004191,
                        .viscous = 0.05071566473605552};

/* The test bench of the fits: supply, gain of the firmware's position loop and its greatest duty. */
static const double supply_v = 15.0, duty_per_rad = 32.0 * 0.158, most_duty = 0.9625;

/* The greatest torque of friction while the servo turns at its speed. outside: what turns it from without */
static double friction(const servo_t *servo, double motor, double outside)
{
    const fit_t *f = &servo->fit;
    const double speed = fabs(servo->speed_rad_per_s);
    const double stuck = exp(-pow(speed / f->stribeck_rad_per_s, f->alpha));
    double held = f->base + stuck * f->base_stribeck + fabs(f->outside * outside - f->motor * motor) +
                  stuck * fabs(f->outside_stribeck * outside - f->motor_stribeck * motor);
    if (outside * motor < 0.0) {
        held +=
            stuck * (fabs(outside) < fabs(motor) ? f->outside_quad * outside * outside : f->motor_quad * motor * motor);
    }
    return servo->friction_factor * (held + f->viscous * speed);
}

void limb_turned(const limb_t *limb, double torque[SERVOS])
{
    const double one = limb->servo[0].angle_rad, two = one - limb->servo[1].angle_rad;
    const double knee_x = limb->femur_m * cos(one), knee_z = limb->femur_m * sin(one);
    const double shank_x = limb->tibia_m * cos(two), shank_z = limb->tibia_m * sin(two);
    const double x = limb->force_n[0], z = limb->force_n[1];
    const double about_knee = shank_x * z - shank_z * x - 0.5 * shank_x * limb->tibia_n;
    torque[0] = about_knee + knee_x * z - knee_z * x - knee_x * (0.5 * limb->femur_n + limb->tibia_n);
    torque[1] = -about_knee;
}

void limb_step(limb_t *limb, double dt_s)
{
    double outside[SERVOS];
    limb_turned(limb, outside);
    const double tibia_kg = limb->tibia_n / 9.81, femur_kg = limb->femur_n / 9.81;
    const double about_knee = tibia_kg * limb->tibia_m * limb->tibia_m / 3.0;
    const double links[SERVOS] = {femur_kg * limb->femur_m * limb->femur_m / 3.0 +
                                      tibia_kg * limb->femur_m * limb->femur_m + about_knee,
                                  about_knee};
    for (int i = 0; i < SERVOS; i++) {
        servo_t *servo = &limb->servo[i];
        const double inertia = servo->fit.armature + links[i];
        const double duty = fmax(-most_duty, fmin(most_duty, duty_per_rad * (servo->goal_rad - servo->angle_rad)));
        servo->current_a = (duty * supply_v - servo->fit.kt * servo->speed_rad_per_s) / servo->fit.r;
        const double motor = servo->fit.kt * servo->current_a, net = motor + outside[i];
        const double stops = inertia / dt_s * servo->speed_rad_per_s + net;
        const double most = friction(servo, motor, outside[i]);
        const double rubs = -copysign(fmin(fabs(stops), most), stops);
        servo->speed_rad_per_s += (net + rubs) / inertia * dt_s;
        servo->angle_rad += servo->speed_rad_per_s * dt_s;
    }
}

static uint64_t next(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

double draw_uniform(uint64_t *state, double low, double high)
{
    return low + (high - low) * (double)(next(state) >> 11) * 0x1p-53;
}

double draw_normal(uint64_t *state)
{
    const double radius = sqrt(-2.0 * log(1.0 - draw_uniform(state, 0.0, 1.0)));
    return radius * cos(6.283185307179586 * draw_uniform(state, 0.0, 1.0));
}
