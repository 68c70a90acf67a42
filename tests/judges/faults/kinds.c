#include "kinds.h"

#include <math.h>

enum { TICK_US = 1000, FOREVER = 1 << 30 };
#define TURN_RAD 6.283185307179586
#define JUMP_LEAST_RAD 0.1 /* no joint turns so far in a millisecond: 50 rad/s and 0.01 rad */
#define GAP_LEAST_RAD 0.3  /* nor so far in 20 ms */

static const struct {
    const char *name, *says;
} kinds[KIND_COUNT] = {
    [KIND_ANGLE_JUMP] = {"angle jumps", "0.1 to 2.5 rad from one sample to the next, and stays there"},
    [KIND_ANGLE_CONSTANT] = {"angle falls", "to 0 or to any constant, 0.1 rad off or more"},
    [KIND_ANGLE_TURN] = {"angle a turn off", "one to three whole turns"},
    [KIND_ANGLE_BIT] = {"angle a bit off", "one of the five highest bits of a turn"},
    [KIND_ANGLE_SWAPPED] = {"joints swapped", "femur's and tibia's angle change places"},
    [KIND_ANGLE_SIGN] = {"angle's sign", "is turned"},
    [KIND_ANGLE_SCALE] = {"angle's scale", "by a factor that moves it by 0.1 rad or more"},
    [KIND_ANGLE_NOISE] = {"angle burst", "each sample up to 3 rad off, none by less than 0.1, for 5 to 300 ms"},
    [KIND_ANGLE_FLIPS] = {"angle's bits flip", "of the five highest, each by itself, for 5 to 300 ms"},
    [KIND_ANGLE_NONE] = {"angle no number", "NaN, infinite or 1e9, 5 to 300 ms"},
    [KIND_SAMPLES_LOST] = {"samples lost", "the drive does not answer, or has nothing newer, 5 to 300 ms"},
    [KIND_LOST_AND_ELSEWHERE] = {"lost, then off", "no samples for 1 to 300 ms, then 0.3 to 2 rad off"},
    [KIND_STAMPS] = {"time stamps", "stand, or run 50 ms to 1,000 s ahead"},
    [KIND_SAMPLES_OLD] = {"samples old", "25 to 200 ms, and say so"},
    [KIND_APART_FROM_START] = {"encoders apart", "from the start on, by 0.5 rad to a turn"},
    [KIND_TORQUE_BEYOND] = {"torque beyond", "1.5 to 100 times what the motor has"},
    [KIND_TORQUE_NONE] = {"torque no number", "NaN or infinite"},
    [KIND_FORCE_BEYOND] = {"force beyond", "1 to 100 times what the sensor has"},
    [KIND_FORCE_NONE] = {"force no number", "NaN, infinite, or no answer"},
    [KIND_DEGC_BEYOND] = {"temperature beyond", "NaN, below -60 or above 150 degC"},
    [KIND_ANGLE_SMALL] = {"angle a little off", "0.002 to 0.05 rad"},
    [KIND_ANGLE_STUCK] = {"angle stuck", "while the limb does what it does"},
    [KIND_ANGLE_DRIFT] = {"angle drifts", "0.005 to 1 rad/s"},
    [KIND_ANGLE_LATE] = {"angle late", "5 to 100 ms, with the time stamp of now"},
    [KIND_ANGLE_TREMBLE] = {"angle trembles", "each sample 0 to 0.3 rad off"},
    [KIND_TORQUE_OFFSET] = {"torque off", "by 0.02 to 0.5 of the motor's range"},
    [KIND_TORQUE_SCALE] = {"torque's scale", "-2 to 2 times"},
    [KIND_TORQUE_STUCK] = {"torque stuck", "at what it was"},
    [KIND_FORCE_OFFSET] = {"force off", "by 0.2 to 20 N"},
    [KIND_FORCE_SCALE] = {"force's scale", "-2 to 2 times"},
    [KIND_FORCE_STUCK] = {"force stuck", "at what it was"},
    [KIND_FORCE_SWAPPED] = {"force's axes", "are swapped"},
    [KIND_DEGC_OFFSET] = {"temperature off", "by 2 to 60 degC"},
};

const char *kind_name(kind_t kind)
{
    return kinds[kind].name;
}

const char *kind_says(kind_t kind)
{
    return kinds[kind].says;
}

bool kind_breaks_a_bound(kind_t kind)
{
    return kind < KIND_ANGLE_SMALL;
}

static float *angle_of(const fault_t *fault, sensors_t *sensors)
{
    brace_hal_joint_t *joint = &sensors->joint[fault->joint];
    return fault->encoder == ENCODER_LINK ? &joint->link_rad : &joint->motor_rad;
}

static double either_way(uint32_t *lots, double low, double high)
{
    return lot_between(lots, low, high) * (lot_bits(lots) % 2u == 0u ? 1.0 : -1.0);
}

/* One of the five highest bits of a turn, set or cleared. */
static double high_bit_rad(uint32_t *lots)
{
    const int bit = (int)(lot_bits(lots) % 5u);
    return either_way(lots, 1.0, 1.0) * ldexp(TURN_RAD, -1 - bit);
}

static int other_joint(int joint)
{
    return joint == BRACE_FEMUR ? BRACE_TIBIA : BRACE_FEMUR;
}

/* How far an angle is from where it was when the samples ended: a limb that moves may hide an offset. */
static double has_moved_rad(const fault_t *f, const plant_t *plant)
{
    sensors_t then;
    fault_t at_begin = *f;
    plant_sense(plant, f->from + (int32_t)f->other, 0, &then);
    return fabs((double)*angle_of(f, &then) + f->size - (double)*angle_of(f, &at_begin.at_begin));
}

/* Numbers of a fault, by its kind. returns whether it is one */
static bool draw_size(fault_t *f, const plant_t *plant)
{
    uint32_t *lots = &f->lots;
    const double angle_rad = (double)*angle_of(f, &f->at_begin);
    const brace_drive_t *drive = &plant->parameters.drive[f->joint];
    switch (f->kind) {
    case KIND_ANGLE_JUMP: f->size = either_way(lots, JUMP_LEAST_RAD, 2.5); return true;
    case KIND_ANGLE_CONSTANT:
        f->size = lot_bits(lots) % 2u == 0u ? 0.0 : lot_between(lots, -3.0, 3.0);
        return fabs(f->size - angle_rad) >= JUMP_LEAST_RAD;
    case KIND_ANGLE_TURN: f->size = either_way(lots, 1.0, 1.0) * TURN_RAD * (1.0 + lot_bits(lots) % 3u); return true;
    case KIND_ANGLE_BIT: f->size = high_bit_rad(lots); return true;
    case KIND_ANGLE_SWAPPED: {
        fault_t other = *f;
        other.joint = other_joint(f->joint);
        return f->joint != BRACE_COXA && fabs((double)*angle_of(&other, &f->at_begin) - angle_rad) >= JUMP_LEAST_RAD;
    }
    case KIND_ANGLE_SIGN: return 2.0 * fabs(angle_rad) >= JUMP_LEAST_RAD;
    case KIND_ANGLE_SCALE:
        f->size = lot_bits(lots) % 2u == 0u ? lot_between(lots, 0.0, 0.9) : lot_between(lots, 1.1, 4.0);
        return fabs((f->size - 1.0) * angle_rad) >= JUMP_LEAST_RAD;
    case KIND_ANGLE_NOISE: f->size = lot_between(lots, 0.3, 3.0); return true;
    case KIND_ANGLE_FLIPS: f->size = lot_between(lots, 0.05, 1.0); return true;
    case KIND_LOST_AND_ELSEWHERE:
        f->size = either_way(lots, GAP_LEAST_RAD, 2.0);
        f->other = 1.0 + lot_bits(lots) % 300u;
        return has_moved_rad(f, plant) >= GAP_LEAST_RAD;
    case KIND_STAMPS: f->size = lot_bits(lots) % 2u == 0u ? 0.0 : lot_between(lots, 50e3, 1e9); return true;
    case KIND_SAMPLES_OLD: f->size = floor(lot_between(lots, 25.0, 200.0)); return true;
    case KIND_APART_FROM_START: f->size = either_way(lots, 0.5, TURN_RAD); return plant->has_link_encoders;
    case KIND_TORQUE_BEYOND:
        f->size = either_way(lots, 1.5, 1.5) * exp(lot_between(lots, 0.0, 4.2)) * (double)drive->torque_range_n_mm;
        return true;
    case KIND_FORCE_BEYOND: f->size = either_way(lots, 60.0, 6000.0); return plant->has_force;
    case KIND_FORCE_NONE: return plant->has_force;
    case KIND_DEGC_BEYOND:
        f->size = lot_bits(lots) % 2u == 0u ? lot_between(lots, 151.0, 5000.0) : -lot_between(lots, 61.0, 5000.0);
        return plant->has_temperature;
    case KIND_ANGLE_SMALL: f->size = either_way(lots, 0.002, 0.05); return true;
    case KIND_ANGLE_DRIFT: f->size = either_way(lots, 0.005, 1.0); return true;
    case KIND_ANGLE_LATE: f->size = floor(lot_between(lots, 5.0, 100.0)); return true;
    case KIND_ANGLE_TREMBLE: f->size = exp(lot_between(lots, log(0.002), log(0.3))); return true;
    case KIND_TORQUE_OFFSET: f->size = either_way(lots, 0.02, 0.5) * (double)drive->torque_range_n_mm; return true;
    case KIND_TORQUE_SCALE: f->size = lot_between(lots, -2.0, 2.0); return true;
    case KIND_FORCE_OFFSET:
        f->size = either_way(lots, 0.2, 20.0);
        f->other = either_way(lots, 0.2, 20.0);
        return plant->has_force;
    case KIND_FORCE_SCALE: f->size = lot_between(lots, -2.0, 2.0); return plant->has_force;
    case KIND_FORCE_STUCK:
    case KIND_FORCE_SWAPPED: return plant->has_force;
    case KIND_DEGC_OFFSET: f->size = either_way(lots, 2.0, 60.0); return plant->has_temperature;
    default: return true;
    }
}

static bool ends_by_itself(kind_t kind)
{
    return kind == KIND_ANGLE_NOISE || kind == KIND_ANGLE_FLIPS || kind == KIND_ANGLE_NONE || kind == KIND_SAMPLES_LOST;
}

bool fault_draw(fault_t *fault, kind_t kind, const plant_t *plant, int32_t from, uint32_t seed)
{
    *fault = (fault_t){.kind = kind, .from = from, .until = FOREVER, .lots = seed * 3266489917u + 668265263u};
    (void)lot_bits(&fault->lots);
    plant_sense(plant, from, 0, &fault->at_begin);
    const uint32_t joints = plant->has_coxa ? 3u : 2u;
    fault->variant = lot_bits(&fault->lots);
    fault->joint = BRACE_TIBIA - (int)(lot_bits(&fault->lots) % joints);
    fault->encoder = plant->has_link_encoders && lot_bits(&fault->lots) % 2u == 0u ? ENCODER_LINK : ENCODER_MOTOR;
    if (ends_by_itself(kind)) {
        fault->until = from + 5 + (int32_t)(lot_bits(&fault->lots) % 296u);
    }
    return draw_size(fault, plant);
}

static float no_number(uint32_t lots)
{
    static const float none[] = {(float)NAN, (float)INFINITY, -(float)INFINITY, 1e9f};
    return none[lots % 4u];
}

static void spoil_angle(fault_t *f, const plant_t *plant, int32_t tick, sensors_t *now)
{
    float *angle_rad = angle_of(f, now);
    fault_t other = *f;
    sensors_t earlier;
    other.joint = other_joint(f->joint);
    switch (f->kind) {
    case KIND_ANGLE_JUMP:
    case KIND_ANGLE_TURN:
    case KIND_ANGLE_BIT:
    case KIND_APART_FROM_START:
    case KIND_ANGLE_SMALL: *angle_rad += (float)f->size; break;
    case KIND_ANGLE_CONSTANT: *angle_rad = (float)f->size; break;
    case KIND_ANGLE_SWAPPED: {
        const float here_rad = *angle_rad;
        *angle_rad = *angle_of(&other, now);
        *angle_of(&other, now) = here_rad;
        break;
    }
    case KIND_ANGLE_SIGN: *angle_rad = -*angle_rad; break;
    case KIND_ANGLE_SCALE: *angle_rad *= (float)f->size; break;
    case KIND_ANGLE_NOISE: *angle_rad += (float)either_way(&f->lots, JUMP_LEAST_RAD, f->size); break;
    case KIND_ANGLE_TREMBLE: *angle_rad += (float)lot_between(&f->lots, -f->size, f->size); break;
    case KIND_ANGLE_FLIPS:
        if (lot_between(&f->lots, 0.0, 1.0) < f->size) {
            *angle_rad += (float)high_bit_rad(&f->lots);
        }
        break;
    case KIND_ANGLE_NONE: *angle_rad = no_number(f->variant); break;
    case KIND_ANGLE_STUCK: *angle_rad = *angle_of(f, &f->at_begin); break;
    case KIND_ANGLE_DRIFT: *angle_rad += (float)(f->size * 1e-3 * (tick - f->from)); break;
    case KIND_ANGLE_LATE:
        plant_sense(plant, tick - (int32_t)f->size, 0, &earlier);
        *angle_rad = *angle_of(f, &earlier);
        break;
    default: break;
    }
}

static void spoil_samples(fault_t *f, const plant_t *plant, int32_t tick, uint32_t tick_us, sensors_t *now)
{
    brace_hal_joint_t *joint = &now->joint[f->joint];
    int32_t *answer = &now->joint_answer[f->joint];
    switch (f->kind) {
    case KIND_SAMPLES_LOST: *answer = f->variant % 2u == 0u ? BRACE_HAL_E_DEVICE : BRACE_HAL_AGAIN; break;
    case KIND_LOST_AND_ELSEWHERE:
        *answer = tick - f->from < (int32_t)f->other ? BRACE_HAL_E_DEVICE : BRACE_HAL_OK;
        *angle_of(f, now) += (float)f->size;
        break;
    case KIND_STAMPS:
        joint->taken_us =
            f->size == 0.0 ? tick_us - (uint32_t)(tick - f->from) * (uint32_t)TICK_US : tick_us + (uint32_t)f->size;
        break;
    case KIND_SAMPLES_OLD: {
        sensors_t earlier;
        plant_sense(plant, tick - (int32_t)f->size, tick_us - (uint32_t)(f->size * TICK_US), &earlier);
        *joint = earlier.joint[f->joint];
        break;
    }
    default: break;
    }
}

static void spoil_others(fault_t *f, sensors_t *now)
{
    brace_hal_joint_t *joint = &now->joint[f->joint];
    const float x_n = now->force_x_n;
    switch (f->kind) {
    case KIND_TORQUE_BEYOND: joint->torque_n_mm = (float)f->size; break;
    case KIND_TORQUE_NONE: joint->torque_n_mm = no_number(f->variant % 3u); break;
    case KIND_TORQUE_OFFSET: joint->torque_n_mm += (float)f->size; break;
    case KIND_TORQUE_SCALE: joint->torque_n_mm *= (float)f->size; break;
    case KIND_TORQUE_STUCK: joint->torque_n_mm = f->at_begin.joint[f->joint].torque_n_mm; break;
    case KIND_FORCE_BEYOND: *(f->variant % 2u == 0u ? &now->force_x_n : &now->force_z_n) = (float)f->size; break;
    case KIND_FORCE_NONE:
        now->force_answer = f->variant % 2u == 0u ? BRACE_HAL_E_DEVICE : BRACE_HAL_OK;
        now->force_z_n = no_number(f->variant % 3u);
        break;
    case KIND_FORCE_OFFSET: now->force_x_n += (float)f->size, now->force_z_n += (float)f->other; break;
    case KIND_FORCE_SCALE: now->force_x_n *= (float)f->size, now->force_z_n *= (float)f->size; break;
    case KIND_FORCE_STUCK: now->force_x_n = f->at_begin.force_x_n, now->force_z_n = f->at_begin.force_z_n; break;
    case KIND_FORCE_SWAPPED: now->force_x_n = now->force_z_n, now->force_z_n = x_n; break;
    case KIND_DEGC_BEYOND:
    case KIND_DEGC_OFFSET:
        for (int i = 0; i < BRACE_LINK_COUNT; i++) { /* one sensor stands in for another: all of them */
            const float degc = now->joint[i].temp_degc + (float)f->size;
            now->joint[i].temp_degc = f->kind == KIND_DEGC_OFFSET ? degc
                                      : f->variant % 4u == 0u     ? (float)NAN
                                                                  : (float)f->size;
        }
        break;
    default: break;
    }
}

void fault_spoil(fault_t *fault, const plant_t *plant, int32_t tick, uint32_t tick_us, sensors_t *sensors)
{
    if (tick < fault->from || tick >= fault->until) {
        return;
    }
    spoil_angle(fault, plant, tick, sensors);
    spoil_samples(fault, plant, tick, tick_us, sensors);
    spoil_others(fault, sensors);
}
