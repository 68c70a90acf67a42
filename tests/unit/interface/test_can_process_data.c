/* Process data over CAN say what was measured, each value under its own name. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "brace/can_frames.h"
#include "brace/can_snapshot.h"
#include "brace/status.h"
#include "unity.h"

#define AGE_MS 12.5f

/* Frame, its member, and the entry that it carries. */
#define REPORTED(X) \
    X(stiffness_a, k_xx_n_per_mm, k_xx_n_per_mm) \
    X(stiffness_a, k_xz_n_per_mm, k_xz_n_per_mm) \
    X(stiffness_b, k_zz_n_per_mm, k_zz_n_per_mm) \
    X(stiffness_b, play_femur, play_femur) \
    X(stiffness_b, play_tibia, play_tibia) \
    X(stiffness_b, mode, mode) \
    X(eigenvalues, lambda_min_n_per_mm, lambda_min_n_per_mm) \
    X(eigenvalues, lambda_max_n_per_mm, lambda_max_n_per_mm) \
    X(eigenvalues, stiff_axis_rad, stiff_axis_rad) \
    X(posture, theta1_rad, theta1_rad) \
    X(posture, theta2_rad, theta2_rad) \
    X(space_0, k_xx_n_per_mm, space_k_xx_n_per_mm) \
    X(space_0, k_xy_n_per_mm, space_k_xy_n_per_mm) \
    X(space_1, k_xz_n_per_mm, space_k_xz_n_per_mm) \
    X(space_1, k_yy_n_per_mm, space_k_yy_n_per_mm) \
    X(space_2, k_yz_n_per_mm, space_k_yz_n_per_mm) \
    X(space_2, k_zz_n_per_mm, space_k_zz_n_per_mm) \
    X(space_3, lambda_1_n_per_mm, space_lambda_1_n_per_mm) \
    X(space_3, lambda_2_n_per_mm, space_lambda_2_n_per_mm) \
    X(space_4, lambda_3_n_per_mm, space_lambda_3_n_per_mm) \
    X(space_5, stiff_axis_x, space_stiff_axis_x) \
    X(space_5, stiff_axis_y, space_stiff_axis_y) \
    X(space_5, stiff_axis_z, space_stiff_axis_z) \
    X(space_6, theta0_rad, theta0_rad) \
    X(space_6, k_across_n_per_mm, k_across_n_per_mm) \
    X(space_6, play_coxa, play_coxa) \
    X(load_0, unloaded_k_xx_n_per_mm, unloaded_k_xx_n_per_mm) \
    X(load_0, unloaded_k_xz_n_per_mm, unloaded_k_xz_n_per_mm) \
    X(load_1, unloaded_k_zz_n_per_mm, unloaded_k_zz_n_per_mm) \
    X(load_2, counted_force_x_n, counted_force_x_n) \
    X(load_2, counted_force_z_n, counted_force_z_n) \
    X(load_3, moved_x_mm, moved_x_mm) \
    X(load_3, moved_z_mm, moved_z_mm) \
    X(load_4, buckling_factor, buckling_factor) \
    X(load_4, gravity_direction_rad, gravity_direction_rad) \
    X(load_5, gravity_lean_rad, gravity_lean_rad) \
    X(load_across_0, counted_force_y_n, counted_force_y_n) \
    X(load_across_0, moved_y_mm, moved_y_mm) \
    X(load_across_1, unloaded_k_across_n_per_mm, unloaded_k_across_n_per_mm) \
    X(sigma_0, k_xx_n_per_mm, sigma_k_xx_n_per_mm) \
    X(sigma_0, k_xz_n_per_mm, sigma_k_xz_n_per_mm) \
    X(sigma_0, k_zz_n_per_mm, sigma_k_zz_n_per_mm) \
    X(sigma_1, lambda_min_n_per_mm, sigma_lambda_min_n_per_mm) \
    X(sigma_1, lambda_max_n_per_mm, sigma_lambda_max_n_per_mm) \
    X(sigma_1, stiff_axis_rad, sigma_stiff_axis_rad) \
    X(sigma_space_0, k_xx_n_per_mm, sigma_space_k_xx_n_per_mm) \
    X(sigma_space_0, k_xy_n_per_mm, sigma_space_k_xy_n_per_mm) \
    X(sigma_space_0, k_xz_n_per_mm, sigma_space_k_xz_n_per_mm) \
    X(sigma_space_1, k_yy_n_per_mm, sigma_space_k_yy_n_per_mm) \
    X(sigma_space_1, k_yz_n_per_mm, sigma_space_k_yz_n_per_mm) \
    X(sigma_space_1, k_zz_n_per_mm, sigma_space_k_zz_n_per_mm) \
    X(sigma_space_2, lambda_1_n_per_mm, sigma_space_lambda_1_n_per_mm) \
    X(sigma_space_2, lambda_2_n_per_mm, sigma_space_lambda_2_n_per_mm) \
    X(sigma_space_2, lambda_3_n_per_mm, sigma_space_lambda_3_n_per_mm) \
    X(sigma_space_3, k_across_n_per_mm, sigma_k_across_n_per_mm) \
    X(snapshot_fd, sequence, sequence) \
    X(snapshot_fd, flags, flags) \
    X(snapshot_fd, mode, mode) \
    X(snapshot_fd, play_femur, play_femur) \
    X(snapshot_fd, play_tibia, play_tibia) \
    X(snapshot_fd, faults, faults) \
    X(snapshot_fd, k_xx_n_per_mm, k_xx_n_per_mm) \
    X(snapshot_fd, k_xz_n_per_mm, k_xz_n_per_mm) \
    X(snapshot_fd, k_zz_n_per_mm, k_zz_n_per_mm) \
    X(snapshot_fd, lambda_min_n_per_mm, lambda_min_n_per_mm) \
    X(snapshot_fd, lambda_max_n_per_mm, lambda_max_n_per_mm) \
    X(snapshot_fd, stiff_axis_rad, stiff_axis_rad) \
    X(snapshot_fd, theta1_rad, theta1_rad) \
    X(snapshot_fd, theta2_rad, theta2_rad) \
    X(snapshot_fd, tip_x_mm, tip_x_mm) \
    X(snapshot_fd, tip_z_mm, tip_z_mm) \
    X(snapshot_fd, force_x_n, force_x_n) \
    X(snapshot_fd, force_z_n, force_z_n) \
    X(space_fd, flags, space_flags) \
    X(space_fd, mode, mode) \
    X(space_fd, play_coxa, play_coxa) \
    X(space_fd, k_across_n_per_mm, k_across_n_per_mm) \
    X(space_fd, k_xx_n_per_mm, space_k_xx_n_per_mm) \
    X(space_fd, k_xy_n_per_mm, space_k_xy_n_per_mm) \
    X(space_fd, k_xz_n_per_mm, space_k_xz_n_per_mm) \
    X(space_fd, k_yy_n_per_mm, space_k_yy_n_per_mm) \
    X(space_fd, k_yz_n_per_mm, space_k_yz_n_per_mm) \
    X(space_fd, k_zz_n_per_mm, space_k_zz_n_per_mm) \
    X(space_fd, lambda_1_n_per_mm, space_lambda_1_n_per_mm) \
    X(space_fd, lambda_2_n_per_mm, space_lambda_2_n_per_mm) \
    X(space_fd, lambda_3_n_per_mm, space_lambda_3_n_per_mm) \
    X(space_fd, theta0_rad, theta0_rad) \
    X(space_fd, stiff_axis_x, space_stiff_axis_x) \
    X(space_fd, stiff_axis_y, space_stiff_axis_y) \
    X(space_fd, stiff_axis_z, space_stiff_axis_z) \
    X(load_fd, flags, flags) \
    X(load_fd, unloaded_k_xx_n_per_mm, unloaded_k_xx_n_per_mm) \
    X(load_fd, unloaded_k_xz_n_per_mm, unloaded_k_xz_n_per_mm) \
    X(load_fd, unloaded_k_zz_n_per_mm, unloaded_k_zz_n_per_mm) \
    X(load_fd, counted_force_x_n, counted_force_x_n) \
    X(load_fd, counted_force_z_n, counted_force_z_n) \
    X(load_fd, moved_x_mm, moved_x_mm) \
    X(load_fd, moved_z_mm, moved_z_mm) \
    X(load_fd, buckling_factor, buckling_factor) \
    X(load_fd, gravity_direction_rad, gravity_direction_rad) \
    X(load_fd, gravity_lean_rad, gravity_lean_rad) \
    X(load_fd, counted_force_y_n, counted_force_y_n) \
    X(load_fd, moved_y_mm, moved_y_mm) \
    X(load_fd, unloaded_k_across_n_per_mm, unloaded_k_across_n_per_mm) \
    X(sigma_fd, k_xx_n_per_mm, sigma_k_xx_n_per_mm) \
    X(sigma_fd, k_xz_n_per_mm, sigma_k_xz_n_per_mm) \
    X(sigma_fd, k_zz_n_per_mm, sigma_k_zz_n_per_mm) \
    X(sigma_fd, lambda_min_n_per_mm, sigma_lambda_min_n_per_mm) \
    X(sigma_fd, lambda_max_n_per_mm, sigma_lambda_max_n_per_mm) \
    X(sigma_fd, stiff_axis_rad, sigma_stiff_axis_rad) \
    X(sigma_fd, space_k_xx_n_per_mm, sigma_space_k_xx_n_per_mm) \
    X(sigma_fd, space_k_xy_n_per_mm, sigma_space_k_xy_n_per_mm) \
    X(sigma_fd, space_k_xz_n_per_mm, sigma_space_k_xz_n_per_mm) \
    X(sigma_fd, space_k_yy_n_per_mm, sigma_space_k_yy_n_per_mm) \
    X(sigma_fd, space_k_yz_n_per_mm, sigma_space_k_yz_n_per_mm) \
    X(sigma_fd, space_k_zz_n_per_mm, sigma_space_k_zz_n_per_mm) \
    X(sigma_fd, space_lambda_1_n_per_mm, sigma_space_lambda_1_n_per_mm) \
    X(sigma_fd, space_lambda_2_n_per_mm, sigma_space_lambda_2_n_per_mm) \
    X(sigma_fd, space_lambda_3_n_per_mm, sigma_space_lambda_3_n_per_mm) \
    X(sigma_fd, k_across_n_per_mm, sigma_k_across_n_per_mm)

void setUp(void) {}

void tearDown(void) {}

/* Small numbers, each its own, that every frame can carry within a step: whole ones for whole numbers. */
static void fill(brace_measured_t *measured)
{
    for (uint32_t i = 0; i < sizeof *measured / 4u; i++) {
        const float value = 0.3f + 0.004f * (float)i;
        memcpy((uint8_t *)measured + 4u * i, &value, 4);
    }
    measured->sequence = 0x1234567u;
    measured->parameter_crc = 0x89abcdefu;
    measured->flags = 1u, measured->space_flags = 2u;
    measured->mode = 3u, measured->faults = 5u;
    measured->play_coxa = 1u, measured->play_femur = 2u, measured->play_tibia = 3u;
}

/* A member that is a number with a step, or a whole one: both are 32 bits. */
static void compare(const char *name, const void *reported, const void *entry)
{
    uint32_t reported_word, word;
    float reported_value, value;
    memcpy(&reported_word, reported, 4);
    memcpy(&word, entry, 4);
    memcpy(&reported_value, reported, 4);
    memcpy(&value, entry, 4);
    if (word < 0x10000000u) {
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(word, reported_word & (word > 255u ? UINT32_MAX : 0xffu), name);
    } else {
        TEST_ASSERT_TRUE_MESSAGE(fabsf(reported_value - value) < 0.0019f, name); /* half of what separates entries */
    }
}

static void test_each_member_is_its_entry(void)
{
    brace_measured_t measured;
    fill(&measured);
#define CHECK(frame, member, entry) \
    { \
        brace_can_##frame##_t message; \
        uint8_t data[64]; \
        brace_can_make_##frame(&measured, AGE_MS, data); \
        brace_can_unpack_##frame(data, &message); \
        compare(#frame " " #member, &message.member, &measured.entry); \
    }
    REPORTED(CHECK)
#undef CHECK
}

static void test_parts_carry_their_snapshot_s_number_age_and_set(void)
{
    brace_measured_t measured;
    uint8_t data[64];
    fill(&measured);
#define SEQUENCE(id, frame, rate, coxa) \
    { \
        brace_can_##frame##_t message; \
        brace_can_make_##frame(&measured, AGE_MS, data); \
        brace_can_unpack_##frame(data, &message); \
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(0x67, message.sequence, #frame); \
    }
    BRACE_CAN_PROCESS(SEQUENCE)
#undef SEQUENCE
    brace_can_stiffness_a_t a;
    brace_can_posture_t posture;
    brace_can_space_4_t space;
    brace_can_snapshot_fd_t snapshot;
    brace_can_space_fd_t space_fd;
    brace_can_load_fd_t load;
    brace_can_make_stiffness_a(&measured, AGE_MS, data);
    brace_can_unpack_stiffness_a(data, &a);
    TEST_ASSERT_FLOAT_WITHIN(1.0f, AGE_MS, a.age_ms);
    brace_can_make_posture(&measured, AGE_MS, data);
    brace_can_unpack_posture(data, &posture);
    TEST_ASSERT_EQUAL_HEX32(0xcdef, posture.parameter_tag);
    brace_can_make_space_4(&measured, AGE_MS, data);
    brace_can_unpack_space_4(data, &space);
    TEST_ASSERT_FLOAT_WITHIN(1.0f, AGE_MS, space.age_ms);
    brace_can_make_snapshot_fd(&measured, AGE_MS, data);
    brace_can_unpack_snapshot_fd(data, &snapshot);
    TEST_ASSERT_FLOAT_WITHIN(0.5f, AGE_MS, snapshot.age_ms);
    brace_can_make_space_fd(&measured, AGE_MS, data);
    brace_can_unpack_space_fd(data, &space_fd);
    TEST_ASSERT_FLOAT_WITHIN(0.5f, AGE_MS, space_fd.age_ms);
    TEST_ASSERT_EQUAL_HEX32(0xcdef, space_fd.parameter_tag);
    brace_can_make_load_fd(&measured, AGE_MS, data);
    brace_can_unpack_load_fd(data, &load);
    TEST_ASSERT_FLOAT_WITHIN(0.5f, AGE_MS, load.age_ms);
}

/* A value beyond what the classic frames carry is flagged in the frame with flags, whichever part it is in; NaN is
 * not. */
static void test_a_value_beyond_its_frame_is_flagged(void)
{
    brace_measured_t measured;
    uint8_t data[64];
    brace_can_stiffness_b_t b;
    brace_can_space_4_t space;
    brace_can_load_1_t load;
    brace_can_load_across_1_t across;
    static const size_t of_a[] = {
        offsetof(brace_measured_t, k_xx_n_per_mm),       offsetof(brace_measured_t, k_xz_n_per_mm),
        offsetof(brace_measured_t, k_zz_n_per_mm),       offsetof(brace_measured_t, lambda_min_n_per_mm),
        offsetof(brace_measured_t, lambda_max_n_per_mm), offsetof(brace_measured_t, stiff_axis_rad)};
    static const size_t of_space[] = {
        offsetof(brace_measured_t, space_k_xx_n_per_mm),    offsetof(brace_measured_t, space_k_xy_n_per_mm),
        offsetof(brace_measured_t, space_k_xz_n_per_mm),    offsetof(brace_measured_t, space_k_yy_n_per_mm),
        offsetof(brace_measured_t, space_k_yz_n_per_mm),    offsetof(brace_measured_t, space_k_zz_n_per_mm),
        offsetof(brace_measured_t, space_lambda_3_n_per_mm)}; /* the greatest */
    static const size_t of_load[] = {offsetof(brace_measured_t, unloaded_k_xx_n_per_mm),
                                     offsetof(brace_measured_t, unloaded_k_xz_n_per_mm),
                                     offsetof(brace_measured_t, unloaded_k_zz_n_per_mm),
                                     offsetof(brace_measured_t, counted_force_x_n),
                                     offsetof(brace_measured_t, counted_force_z_n),
                                     offsetof(brace_measured_t, moved_x_mm),
                                     offsetof(brace_measured_t, moved_z_mm),
                                     offsetof(brace_measured_t, gravity_lean_rad)};
    static const size_t of_across[] = {offsetof(brace_measured_t, counted_force_y_n),
                                       offsetof(brace_measured_t, moved_y_mm),
                                       offsetof(brace_measured_t, unloaded_k_across_n_per_mm)};
    static const struct {
        const size_t *at;
        uint32_t count;
    } all[] = {{of_a, 6}, {of_space, 7}, {of_load, 8}, {of_across, 3}};
    static const float far[] = {1e30f, -1e30f, NAN};
    for (uint32_t group = 0; group < 4u; group++) {
        for (uint32_t i = 0; i < 3u * all[group].count; i++) {
            fill(&measured);
            measured.flags = measured.space_flags = 0;
            memcpy((uint8_t *)&measured + all[group].at[i / 3u], &far[i % 3u], 4);
            brace_can_make_stiffness_b(&measured, AGE_MS, data);
            brace_can_unpack_stiffness_b(data, &b);
            brace_can_make_space_4(&measured, AGE_MS, data);
            brace_can_unpack_space_4(data, &space);
            brace_can_make_load_1(&measured, AGE_MS, data);
            brace_can_unpack_load_1(data, &load);
            brace_can_make_load_across_1(&measured, AGE_MS, data);
            brace_can_unpack_load_across_1(data, &across);
            const uint32_t wanted = i % 3u < 2u ? (uint32_t)BRACE_FLAG_SATURATED : 0u;
            TEST_ASSERT_EQUAL_HEX32(group == 0u ? wanted : 0u, b.flags);
            TEST_ASSERT_EQUAL_HEX32(group == 1u ? wanted : 0u, space.flags);
            TEST_ASSERT_EQUAL_HEX32(group == 2u ? wanted : 0u, load.flags);
            TEST_ASSERT_EQUAL_HEX32(group == 3u ? wanted : 0u, across.flags);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_member_is_its_entry);
    RUN_TEST(test_parts_carry_their_snapshot_s_number_age_and_set);
    RUN_TEST(test_a_value_beyond_its_frame_is_flagged);
    return UNITY_END();
}
