/* Kinematics against double-precision trigonometry, and the inverse against the forward map. */
#include <float.h>
#include <string.h>

#include "brace/kinematics.h"
#include "close.h"

static const double PI = 3.14159265358979323846;

void setUp(void) {}
void tearDown(void) {}

static brace_limb_t limb_of(float coxa_mm, float femur_mm, float tibia_mm)
{
    brace_limb_t limb;
    memset(&limb, 0, sizeof limb);
    limb.coxa_mm = coxa_mm;
    limb.femur_mm = femur_mm;
    limb.tibia_mm = tibia_mm;
    return limb;
}

static brace_limb_t paper_limb(void)
{
    return limb_of(57.0f, 185.0f, 313.5f);
}

/* The paper's limb, equal links, a long femur, very unequal links, the smallest and the largest. */
static const float lengths_mm[][2] = {{185.0f, 313.5f}, {200.0f, 200.0f}, {300.0f, 120.0f},
                                      {1000.0f, 7.0f},  {1.0f, 1.0f},     {1e4f, 1e4f}};
enum { LIMBS = sizeof lengths_mm / sizeof lengths_mm[0] };

/* Angles over a turn, with the straight and the folded knee approached from far to one unit in the last
 * place. */
enum { SWEEP = 61 };
static float sweep(int i)
{
    static const double near[] = {0.0, 1e-7, 1e-5, 1e-3, 3e-2};
    if (i < 41) {
        return (float)(-PI + i * (2.0 * PI / 40.0));
    }
    const double sign = i % 2 != 0 ? 1.0 : -1.0;
    const double from = (i - 41) % 4 < 2 ? 0.0 : PI;
    return (float)(sign * (from == 0.0 ? near[(i - 41) / 4] : from - near[(i - 41) / 4]));
}

static void forward_matches_double_trigonometry(void)
{
    for (int k = 0; k < LIMBS; k++) {
        const brace_limb_t limb = limb_of(0.0f, lengths_mm[k][0], lengths_mm[k][1]);
        const double reach = (double)limb.femur_mm + (double)limb.tibia_mm;
        const double tolerance = 3e-7 * reach;
        for (int i = 0; i < SWEEP; i++) {
            for (int j = 0; j < SWEEP; j += 3) {
                const float theta1 = 2.0f * sweep(j);
                const float theta2 = sweep(i);
                brace_pose_t pose;
                TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_kinematics_forward(&limb, theta1, theta2, &pose));
                const double knee_x = (double)limb.femur_mm * cos((double)theta1);
                const double knee_z = (double)limb.femur_mm * sin((double)theta1);
                const double shank_x = (double)limb.tibia_mm * cos((double)theta1 - (double)theta2);
                const double shank_z = (double)limb.tibia_mm * sin((double)theta1 - (double)theta2);
                ASSERT_CLOSE(knee_x, pose.knee.x_mm, tolerance);
                ASSERT_CLOSE(knee_z, pose.knee.z_mm, tolerance);
                ASSERT_CLOSE(knee_x + shank_x, pose.tip.x_mm, tolerance);
                ASSERT_CLOSE(knee_z + shank_z, pose.tip.z_mm, tolerance);
                ASSERT_CLOSE(-(knee_z + shank_z), pose.lever_femur.x_mm, tolerance);
                ASSERT_CLOSE(knee_x + shank_x, pose.lever_femur.z_mm, tolerance);
                ASSERT_CLOSE(-shank_z, pose.lever_tibia.x_mm, tolerance);
                ASSERT_CLOSE(shank_x, pose.lever_tibia.z_mm, tolerance);
            }
        }
    }
}

/* Levers are what the tip does when a joint turns: theta1 forwards, theta2 backwards (flexion is clockwise).
 */
static void levers_are_the_tips_derivatives(void)
{
    const brace_limb_t limb = paper_limb();
    const float step = 1.0f / 64.0f; /* central differences: error step^2/6 of the lever, 4e-5 */
    brace_pose_t at, plus, minus;
    brace_kinematics_forward(&limb, 1.0f, 1.4f, &at);
    brace_kinematics_forward(&limb, 1.0f + step, 1.4f, &plus);
    brace_kinematics_forward(&limb, 1.0f - step, 1.4f, &minus);
    ASSERT_CLOSE(at.lever_femur.x_mm, (plus.tip.x_mm - minus.tip.x_mm) / (2.0f * step), 0.05);
    ASSERT_CLOSE(at.lever_femur.z_mm, (plus.tip.z_mm - minus.tip.z_mm) / (2.0f * step), 0.05);
    brace_kinematics_forward(&limb, 1.0f, 1.4f - step, &plus);
    brace_kinematics_forward(&limb, 1.0f, 1.4f + step, &minus);
    ASSERT_CLOSE(at.lever_tibia.x_mm, (plus.tip.x_mm - minus.tip.x_mm) / (2.0f * step), 0.05);
    ASSERT_CLOSE(at.lever_tibia.z_mm, (plus.tip.z_mm - minus.tip.z_mm) / (2.0f * step), 0.05);
}

static void polar_form(void)
{
    for (int i = 0; i < SWEEP; i++) {
        const double phi = (double)sweep(i);
        const brace_point_t point = {(float)(437.0 * cos(phi)), (float)(437.0 * sin(phi))};
        brace_polar_t polar;
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_kinematics_polar(point, &polar));
        ASSERT_CLOSE(437.0, polar.r_mm, 2e-7 * 437.0);
        ASSERT_CLOSE(atan2((double)point.z_mm, (double)point.x_mm), polar.phi_rad, 3e-7);
    }
    brace_polar_t origin;
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_kinematics_polar((brace_point_t){0.0f, 0.0f}, &origin));
    TEST_ASSERT_TRUE(origin.r_mm == 0.0f && origin.phi_rad == 0.0f);
}

/* r^2 = L1^2 + L2^2 + 2 L1 L2 cos(theta2) */
static void r_follows_the_knee(void)
{
    const brace_limb_t limb = paper_limb();
    for (int i = 0; i < SWEEP; i++) {
        brace_pose_t pose;
        brace_polar_t polar;
        brace_kinematics_forward(&limb, 0.3f, sweep(i), &pose);
        brace_kinematics_polar(pose.tip, &polar);
        const double r = sqrt(185.0 * 185.0 + 313.5 * 313.5 + 2.0 * 185.0 * 313.5 * cos((double)sweep(i)));
        ASSERT_CLOSE(r, polar.r_mm, 5e-7 * 498.5);
    }
}

/* Angles -> tip -> angles -> tip. The last tip must be where it was asked for, however ill the angles are
 * conditioned. The angles differ by what an error e of the tip does to them: with h = e r / (L1 L2),
 * |cos difference of theta2| <= h, so |difference| <= h / |sin theta2| to first order, and always <= pi
 * sqrt(h/2). */
static void inverse_undoes_forward(void)
{
    for (int k = 0; k < LIMBS; k++) {
        const brace_limb_t limb = limb_of(0.0f, lengths_mm[k][0], lengths_mm[k][1]);
        const double l1 = (double)limb.femur_mm, l2 = (double)limb.tibia_mm, reach = l1 + l2;
        for (int i = 0; i < SWEEP; i++) {
            for (int j = 0; j < SWEEP; j += 3) {
                const float theta1 = sweep(j), theta2 = sweep(i);
                const brace_knee_t knee = theta2 >= 0.0f ? BRACE_KNEE_UP : BRACE_KNEE_DOWN;
                brace_pose_t asked, got;
                brace_kinematics_forward(&limb, theta1, theta2, &asked);
                float back1, back2;
                TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_kinematics_inverse(&limb, asked.tip, knee, &back1, &back2));
                TEST_ASSERT_TRUE(back1 >= -3.1415930f && back1 <= 3.1415930f);
                TEST_ASSERT_TRUE(knee == BRACE_KNEE_UP ? back2 >= 0.0f && back2 <= 3.1415930f
                                                       : back2 <= 0.0f && back2 >= -3.1415930f);
                brace_kinematics_forward(&limb, back1, back2, &got);
                ASSERT_CLOSE(asked.tip.x_mm, got.tip.x_mm, 1e-6 * reach);
                ASSERT_CLOSE(asked.tip.z_mm, got.tip.z_mm, 1e-6 * reach);

                const double r = sqrt(l1 * l1 + l2 * l2 + 2.0 * l1 * l2 * cos((double)theta2));
                const double e = 8e-7 * reach; /* forward 3e-7, edge 5e-7 */
                const double h = e * (r + e) / (l1 * l2);
                const double always = PI * sqrt(h / 2.0);
                const double smooth = 2.0 * h / (fabs(sin((double)theta2)) + 1e-12);
                const double bound = 1e-6 + (smooth < always ? smooth : always);
                ASSERT_CLOSE(fabs((double)theta2), fabs((double)back2), bound);
                if (r > 1e-3 * reach) {
                    const double turned = remainder((double)back1 - (double)theta1, 2.0 * PI);
                    ASSERT_CLOSE(0.0, turned, 1.5e-6 + 0.5 * PI * (e + l2 * bound) / r);
                }
            }
        }
    }
}

static void knees_lie_on_their_side(void)
{
    const brace_limb_t limb = paper_limb();
    const brace_point_t tips[] = {{300.0f, -120.0f}, {-250.0f, 90.0f}, {10.0f, -400.0f}, {0.0f, 200.0f}};
    for (int i = 0; i < 4; i++) {
        for (int knee = BRACE_KNEE_UP; knee <= BRACE_KNEE_DOWN; knee++) {
            float theta1, theta2;
            brace_pose_t pose;
            TEST_ASSERT_EQUAL_INT(BRACE_OK,
                                  brace_kinematics_inverse(&limb, tips[i], (brace_knee_t)knee, &theta1, &theta2));
            brace_kinematics_forward(&limb, theta1, theta2, &pose);
            const float left_of_line = tips[i].x_mm * pose.knee.z_mm - tips[i].z_mm * pose.knee.x_mm;
            TEST_ASSERT_TRUE(knee == BRACE_KNEE_UP ? left_of_line > 0.0f : left_of_line < 0.0f);
        }
    }
}

/* Right angle at the knee: 3-4-5. theta2 = pi/2, and the femur leads the tip by asin(4/5). */
static void a_known_triangle(void)
{
    const brace_limb_t limb = limb_of(0.0f, 3.0f, 4.0f);
    float theta1, theta2;
    TEST_ASSERT_EQUAL_INT(
        BRACE_OK, brace_kinematics_inverse(&limb, (brace_point_t){0.0f, 5.0f}, BRACE_KNEE_UP, &theta1, &theta2));
    ASSERT_CLOSE(PI / 2.0, theta2, 1e-6);
    ASSERT_CLOSE(PI / 2.0 + asin(0.8), theta1, 1e-6);
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_kinematics_inverse_polar(&limb, (brace_polar_t){5.0f, 0.0f}, BRACE_KNEE_DOWN,
                                                                   &theta1, &theta2));
    ASSERT_CLOSE(-PI / 2.0, theta2, 1e-6);
    ASSERT_CLOSE(-asin(0.8), theta1, 1e-6);
    /* The direction is kept within half a turn, wherever it is asked from. */
    TEST_ASSERT_EQUAL_INT(
        BRACE_OK, brace_kinematics_inverse_polar(&limb, (brace_polar_t){5.0f, 7.5f}, BRACE_KNEE_UP, &theta1, &theta2));
    ASSERT_CLOSE(7.5 + asin(0.8) - 2.0 * PI, theta1, 1.5e-6);
    TEST_ASSERT_EQUAL_INT(
        BRACE_OK, brace_kinematics_inverse_polar(&limb, (brace_polar_t){5.0f, 3.0f}, BRACE_KNEE_UP, &theta1, &theta2));
    ASSERT_CLOSE(3.0 + asin(0.8) - 2.0 * PI, theta1, 1.5e-6);
}

/* Near straight, theta2 = sqrt(2 (S - r) S / (L1 L2)) to first order. Written as a difference of squares of
 * rounded lengths, half of these digits would be lost. */
static void nearly_straight_is_sharp(void)
{
    const brace_limb_t limb = limb_of(0.0f, 128.0f, 256.0f);
    const float shortfalls_mm[] = {1.0f / 1024.0f, 1.0f / 8192.0f, 1.0f / 32768.0f};
    for (int i = 0; i < 3; i++) {
        float theta1, theta2;
        const float r_mm = 384.0f - shortfalls_mm[i]; /* exact */
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_kinematics_inverse_polar(&limb, (brace_polar_t){r_mm, 0.0f},
                                                                       BRACE_KNEE_UP, &theta1, &theta2));
        const double cosine = ((double)r_mm * (double)r_mm - 128.0 * 128.0 - 256.0 * 256.0) / (2.0 * 128.0 * 256.0);
        const double exact = 2.0 * asin(sqrt((1.0 - cosine) / 2.0));
        ASSERT_CLOSE(exact, theta2, 6e-7 * exact);
    }
    /* and folded: r = 128 + shortfall */
    float theta1, theta2;
    const float r_mm = 128.0f + 1.0f / 65536.0f;
    brace_kinematics_inverse_polar(&limb, (brace_polar_t){r_mm, 0.0f}, BRACE_KNEE_UP, &theta1, &theta2);
    const double cosine = ((double)r_mm * (double)r_mm - 128.0 * 128.0 - 256.0 * 256.0) / (2.0 * 128.0 * 256.0);
    ASSERT_CLOSE(PI - 2.0 * asin(sqrt((1.0 + cosine) / 2.0)), theta2, 6e-7);
}

static void equal_links_reach_the_origin(void)
{
    const brace_limb_t limb = limb_of(0.0f, 200.0f, 200.0f);
    float theta1, theta2;
    TEST_ASSERT_EQUAL_INT(
        BRACE_OK, brace_kinematics_inverse(&limb, (brace_point_t){0.0f, 0.0f}, BRACE_KNEE_UP, &theta1, &theta2));
    ASSERT_CLOSE(PI, theta2, 3e-7);
    TEST_ASSERT_TRUE(theta1 == 0.0f);
}

static void spatial_is_the_plane_carried_round(void)
{
    const brace_limb_t limb = paper_limb();
    const double reach = 57.0 + 185.0 + 313.5;
    for (int i = 0; i < SWEEP; i += 4) {
        for (int j = 0; j < SWEEP; j += 4) {
            for (int k = 0; k < SWEEP; k += 5) {
                const float theta0 = sweep(k), theta1 = sweep(j), theta2 = sweep(i);
                brace_pose_t pose;
                brace_point_spatial_t tip, again;
                brace_kinematics_forward(&limb, theta1, theta2, &pose);
                TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_kinematics_forward_spatial(&limb, theta0, theta1, theta2, &tip));
                const double out = 57.0 + (double)pose.tip.x_mm;
                ASSERT_CLOSE(out * cos((double)theta0), tip.x_mm, 5e-7 * reach);
                ASSERT_CLOSE(out * sin((double)theta0), tip.y_mm, 5e-7 * reach);
                ASSERT_CLOSE(pose.tip.z_mm, tip.z_mm, 0.0);

                const brace_yaw_t yaw = out >= 0.0 ? BRACE_YAW_TOWARDS : BRACE_YAW_AWAY;
                const brace_knee_t knee = theta2 >= 0.0f ? BRACE_KNEE_UP : BRACE_KNEE_DOWN;
                float back0, back1, back2;
                TEST_ASSERT_EQUAL_INT(BRACE_OK,
                                      brace_kinematics_inverse_spatial(&limb, tip, yaw, knee, &back0, &back1, &back2));
                brace_kinematics_forward_spatial(&limb, back0, back1, back2, &again);
                ASSERT_CLOSE(tip.x_mm, again.x_mm, 1e-6 * reach);
                ASSERT_CLOSE(tip.y_mm, again.y_mm, 1e-6 * reach);
                ASSERT_CLOSE(tip.z_mm, again.z_mm, 1e-6 * reach);
                if (fabs(out) > 1.0) {
                    const double turned = remainder((double)back0 - (double)theta0, 2.0 * PI);
                    ASSERT_CLOSE(0.0, turned, 1e-6 + 5e-7 * reach / fabs(out));
                }
            }
        }
    }
}

static void both_yaws_reach_a_point_over_the_coxa(void)
{
    const brace_limb_t limb = paper_limb();
    const brace_point_spatial_t tip = {30.0f, 40.0f, 250.0f};
    for (int yaw = BRACE_YAW_TOWARDS; yaw <= BRACE_YAW_AWAY; yaw++) {
        float theta0, theta1, theta2;
        brace_point_spatial_t again;
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_kinematics_inverse_spatial(&limb, tip, (brace_yaw_t)yaw, BRACE_KNEE_UP,
                                                                         &theta0, &theta1, &theta2));
        ASSERT_CLOSE(atan2(40.0, 30.0) - (yaw == BRACE_YAW_AWAY ? PI : 0.0), theta0, 5e-7);
        brace_kinematics_forward_spatial(&limb, theta0, theta1, theta2, &again);
        ASSERT_CLOSE(30.0, again.x_mm, 2e-3);
        ASSERT_CLOSE(40.0, again.y_mm, 2e-3);
        ASSERT_CLOSE(250.0, again.z_mm, 2e-3);
    }
}

static void yaw_is_zero_where_any_would_do(void)
{
    const brace_limb_t limb = paper_limb();
    for (int yaw = BRACE_YAW_TOWARDS; yaw <= BRACE_YAW_AWAY; yaw++) {
        float theta0 = 11.0f, theta1, theta2;
        TEST_ASSERT_EQUAL_INT(
            BRACE_OK, brace_kinematics_inverse_spatial(&limb, (brace_point_spatial_t){0.0f, 0.0f, 200.0f},
                                                       (brace_yaw_t)yaw, BRACE_KNEE_UP, &theta0, &theta1, &theta2));
        TEST_ASSERT_TRUE(theta0 == 0.0f);
    }
}

static void expect_unreachable(const brace_limb_t *limb, float x_mm, float z_mm)
{
    float theta1 = 11.0f, theta2 = 12.0f;
    TEST_ASSERT_EQUAL_INT(BRACE_E_UNREACHABLE,
                          brace_kinematics_inverse(limb, (brace_point_t){x_mm, z_mm}, BRACE_KNEE_UP, &theta1, &theta2));
    TEST_ASSERT_TRUE(theta1 == 11.0f && theta2 == 12.0f);
}

static void unreachable_is_refused(void)
{
    const brace_limb_t paper = paper_limb();
    expect_unreachable(&paper, 498.501f, 0.0f); /* 1 um beyond 498.5, four times the edge's tolerance */
    expect_unreachable(&paper, 128.499f, 0.0f); /* inside the folded limb's 128.5 */
    expect_unreachable(&paper, 0.0f, 0.0f);
    expect_unreachable(&paper, -1e6f, 1e6f);
    const brace_limb_t long_femur = limb_of(0.0f, 300.0f, 120.0f);
    expect_unreachable(&long_femur, 0.0f, 179.999f);
    expect_unreachable(&long_femur, 0.0f, -420.001f);

    float theta0 = 10.0f, theta1 = 11.0f, theta2 = 12.0f;
    const brace_point_spatial_t far_away = {0.0f, 600.0f, 0.0f};
    TEST_ASSERT_EQUAL_INT(BRACE_E_UNREACHABLE,
                          brace_kinematics_inverse_spatial(&paper, far_away, BRACE_YAW_TOWARDS, BRACE_KNEE_UP, &theta0,
                                                           &theta1, &theta2));
    TEST_ASSERT_TRUE(theta0 == 10.0f && theta1 == 11.0f && theta2 == 12.0f);
}

static void the_edge_itself_is_reached(void)
{
    const brace_limb_t limb = paper_limb();
    float theta1, theta2;
    TEST_ASSERT_EQUAL_INT(
        BRACE_OK, brace_kinematics_inverse(&limb, (brace_point_t){498.5f, 0.0f}, BRACE_KNEE_UP, &theta1, &theta2));
    TEST_ASSERT_TRUE(theta1 == 0.0f && theta2 == 0.0f);
    TEST_ASSERT_EQUAL_INT(
        BRACE_OK, brace_kinematics_inverse(&limb, (brace_point_t){498.5002f, 0.0f}, BRACE_KNEE_UP, &theta1, &theta2));
    TEST_ASSERT_TRUE(theta2 == 0.0f);
    TEST_ASSERT_EQUAL_INT(
        BRACE_OK, brace_kinematics_inverse(&limb, (brace_point_t){128.5f, 0.0f}, BRACE_KNEE_UP, &theta1, &theta2));
    ASSERT_CLOSE(PI, theta2, 3e-7);
    ASSERT_CLOSE(PI, fabs((double)theta1), 3e-7); /* the tibia is the longer: the femur points away */
}

static void expect_untouched_forward(const brace_limb_t *limb, float theta1, float theta2, brace_status_t expected)
{
    brace_pose_t pose, before;
    memset(&pose, 0x5a, sizeof pose);
    before = pose;
    TEST_ASSERT_EQUAL_INT(expected, brace_kinematics_forward(limb, theta1, theta2, &pose));
    TEST_ASSERT_EQUAL_INT(0, memcmp(&before, &pose, sizeof pose));
    brace_point_spatial_t tip = {1.0f, 2.0f, 3.0f};
    TEST_ASSERT_EQUAL_INT(expected, brace_kinematics_forward_spatial(limb, 0.0f, theta1, theta2, &tip));
    TEST_ASSERT_TRUE(tip.x_mm == 1.0f && tip.y_mm == 2.0f && tip.z_mm == 3.0f);
}

static void expect_untouched_inverse(const brace_limb_t *limb, float x_mm, float z_mm, int knee,
                                     brace_status_t expected)
{
    float theta0 = 10.0f, theta1 = 11.0f, theta2 = 12.0f;
    TEST_ASSERT_EQUAL_INT(
        expected, brace_kinematics_inverse(limb, (brace_point_t){x_mm, z_mm}, (brace_knee_t)knee, &theta1, &theta2));
    TEST_ASSERT_EQUAL_INT(expected, brace_kinematics_inverse_spatial(limb, (brace_point_spatial_t){x_mm, 0.0f, z_mm},
                                                                     BRACE_YAW_TOWARDS, (brace_knee_t)knee, &theta0,
                                                                     &theta1, &theta2));
    TEST_ASSERT_TRUE(theta0 == 10.0f && theta1 == 11.0f && theta2 == 12.0f);
}

static void bad_input_is_refused_and_touches_nothing(void)
{
    const brace_limb_t limb = paper_limb();
    expect_untouched_forward(NULL, 0.0f, 0.0f, BRACE_E_NULL);
    expect_untouched_forward(&limb, NAN, 0.0f, BRACE_E_NOT_FINITE);
    expect_untouched_forward(&limb, 0.0f, INFINITY, BRACE_E_NOT_FINITE);
    expect_untouched_forward(&limb, 8.0f, 0.0f, BRACE_E_RANGE);
    expect_untouched_forward(&limb, 0.0f, -8.0f, BRACE_E_RANGE);
    const float bad_lengths_mm[] = {0.0f, 0.5f, -185.0f, 1.1e4f, INFINITY, NAN};
    for (int i = 0; i < 6; i++) {
        const brace_limb_t bad_femur = limb_of(57.0f, bad_lengths_mm[i], 313.5f);
        const brace_limb_t bad_tibia = limb_of(57.0f, 185.0f, bad_lengths_mm[i]);
        expect_untouched_forward(&bad_femur, 0.0f, 0.0f, BRACE_E_PARAMETER);
        expect_untouched_forward(&bad_tibia, 0.0f, 0.0f, BRACE_E_PARAMETER);
        expect_untouched_inverse(&bad_femur, 300.0f, 0.0f, BRACE_KNEE_UP, BRACE_E_PARAMETER);
        expect_untouched_inverse(&bad_tibia, 300.0f, 0.0f, BRACE_KNEE_UP, BRACE_E_PARAMETER);
    }
    const brace_limb_t bad_coxa = limb_of(-1.0f, 185.0f, 313.5f);
    const brace_limb_t nan_coxa = limb_of(NAN, 185.0f, 313.5f);
    expect_untouched_forward(&bad_coxa, 0.0f, 0.0f, BRACE_E_PARAMETER);
    expect_untouched_forward(&nan_coxa, 0.0f, 0.0f, BRACE_E_PARAMETER);

    expect_untouched_inverse(NULL, 300.0f, 0.0f, BRACE_KNEE_UP, BRACE_E_NULL);
    expect_untouched_inverse(&limb, NAN, 0.0f, BRACE_KNEE_UP, BRACE_E_NOT_FINITE);
    expect_untouched_inverse(&limb, 300.0f, -INFINITY, BRACE_KNEE_UP, BRACE_E_NOT_FINITE);
    expect_untouched_inverse(&limb, 300.0f, FLT_MAX, BRACE_KNEE_UP, BRACE_E_RANGE);
    expect_untouched_inverse(&limb, 300.0f, 0.0f, 2, BRACE_E_RANGE);

    float angle = 7.0f;
    brace_pose_t *const no_pose = NULL;
    brace_point_spatial_t tip = {300.0f, 0.0f, 0.0f};
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_kinematics_forward(&limb, 0.0f, 0.0f, no_pose));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_kinematics_forward_spatial(&limb, 0.0f, 0.0f, 0.0f, NULL));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, brace_kinematics_forward_spatial(&limb, NAN, 0.0f, 0.0f, &tip));
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_kinematics_forward_spatial(&limb, 9.0f, 0.0f, 0.0f, &tip));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_kinematics_polar((brace_point_t){1.0f, 1.0f}, NULL));
    const brace_polar_t straight = {300.0f, 0.0f};
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_kinematics_inverse_polar(&limb, straight, BRACE_KNEE_UP, NULL, &angle));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_kinematics_inverse_polar(&limb, straight, BRACE_KNEE_UP, &angle, NULL));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_kinematics_inverse_spatial(&limb, tip, BRACE_YAW_AWAY, BRACE_KNEE_UP,
                                                                         NULL, &angle, &angle));
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_kinematics_inverse_spatial(&limb, tip, (brace_yaw_t)2, BRACE_KNEE_UP,
                                                                          &angle, &angle, &angle));
    const brace_polar_t bad_polar[] = {{-1.0f, 0.0f}, {300.0f, 8.0f}, {NAN, 0.0f}, {300.0f, NAN}, {3e6f, 0.0f}};
    const brace_status_t refusal[] = {BRACE_E_RANGE, BRACE_E_RANGE, BRACE_E_NOT_FINITE, BRACE_E_NOT_FINITE,
                                      BRACE_E_RANGE};
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL_INT(refusal[i],
                              brace_kinematics_inverse_polar(&limb, bad_polar[i], BRACE_KNEE_UP, &angle, &angle));
    }
    TEST_ASSERT_TRUE(angle == 7.0f && tip.x_mm == 300.0f);
}

static void a_direction_is_reported_of_every_angle_in_range(void)
{
    for (int i = -79; i <= 79; i++) {
        const float angle_rad = 0.1f * (float)i;
        brace_vec_t direction = {9.0f, 9.0f};
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_kinematics_direction(angle_rad, &direction));
        ASSERT_CLOSE(cos((double)angle_rad), direction.x, 3e-7);
        ASSERT_CLOSE(sin((double)angle_rad), direction.z, 3e-7);
    }
    brace_vec_t untouched = {9.0f, 8.0f};
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_kinematics_direction(7.91f, &untouched));
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_kinematics_direction(-7.91f, &untouched));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, brace_kinematics_direction((float)NAN, &untouched));
    TEST_ASSERT_TRUE(untouched.x == 9.0f && untouched.z == 8.0f);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(forward_matches_double_trigonometry);
    RUN_TEST(levers_are_the_tips_derivatives);
    RUN_TEST(polar_form);
    RUN_TEST(r_follows_the_knee);
    RUN_TEST(inverse_undoes_forward);
    RUN_TEST(knees_lie_on_their_side);
    RUN_TEST(a_known_triangle);
    RUN_TEST(nearly_straight_is_sharp);
    RUN_TEST(equal_links_reach_the_origin);
    RUN_TEST(spatial_is_the_plane_carried_round);
    RUN_TEST(both_yaws_reach_a_point_over_the_coxa);
    RUN_TEST(yaw_is_zero_where_any_would_do);
    RUN_TEST(unreachable_is_refused);
    RUN_TEST(the_edge_itself_is_reached);
    RUN_TEST(bad_input_is_refused_and_touches_nothing);
    RUN_TEST(a_direction_is_reported_of_every_angle_in_range);
    return UNITY_END();
}
