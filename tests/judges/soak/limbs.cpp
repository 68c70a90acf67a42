#include "limbs.h"

#include <cmath>

namespace soak {
namespace {

// One sigma each, as the controllers' parameters say.
constexpr double kLength_mm = 0.3, kAngle_rad = 0.002, kCompliance_rel = 0.03, kGain_rel = 0.01;

struct Setting {
    const char *name;
    bool has_play, is_heavy, is_in_space;
};
constexpr Setting kSettings[kLimbs] = {{"plain", false, false, false},
                                       {"play", true, false, false},
                                       {"heavy", false, true, false},
                                       {"in space", false, false, true}};

brace_node_limb_t nominal(const Setting &setting)
{
    brace_node_limb_t limb;
    brace_node_limb_default(&limb);
    limb.theta_rad[kFemur] = kTheta1_rad;
    limb.theta_rad[kTibia] = kTheta2_rad;
    if (setting.has_play) {
        limb.plant.joint[kFemur].gap_rad = 0.006;
        limb.plant.joint[kTibia].gap_rad = 0.008;
    }
    if (setting.is_heavy) {
        limb.plant.link[kFemur].moment_transfer = limb.plant.link[kTibia].moment_transfer = 1.0;
        limb.plant.gravity = {2.0, 1.5, 1.0, -M_PI_2, 0.0};
    }
    if (setting.is_in_space) {
        limb.plant.joint[0].compliance_rad_per_n_mm = 8e-6;
        limb.plant.link[kFemur].lateral_mm_per_n = 0.06;
        limb.plant.link[kTibia].lateral_mm_per_n = 0.25;
    }
    return limb;
}

brace_parameters_t parameters_of(const brace_node_limb_t &limb, std::uint32_t node)
{
    const auto number = [](double value) { return static_cast<float>(value); };
    brace_parameters_t p;
    brace_parameters_default(&p);
    const brace_plant_model_t &plant = limb.plant;
    p.limb.coxa_mm = number(plant.geometry.coxa_mm);
    p.limb.femur_mm = number(plant.geometry.femur_mm);
    p.limb.tibia_mm = number(plant.geometry.tibia_mm);
    for (int i = 0; i < BRACE_LINK_COUNT; ++i) {
        const brace_plant_link_t &link = plant.link[i];
        const brace_node_drive_t &drive = limb.drive[i];
        p.limb.link[i] = {};
        p.limb.link[i].axial_mm_per_n = number(link.axial_mm_per_n);
        p.limb.link[i].bending_mm_per_n = number(link.bending_mm_per_n);
        p.limb.link[i].lateral_mm_per_n = number(link.lateral_mm_per_n);
        p.limb.link[i].moment_transfer = number(link.moment_transfer);
        p.limb.joint[i] = {number(plant.joint[i].compliance_rad_per_n_mm), number(plant.joint[i].gap_rad), 0.0f};
        brace_drive_t &reported = p.drive[i];
        reported.motor_friction_n_mm = number(drive.friction_n_mm);
        reported.motor_friction_tolerance_ratio = 0.2f;
        reported.motor_inertia_n_mm_s2_per_rad = number(drive.inertia_n_mm_s2_per_rad);
        reported.torque_range_n_mm = number(drive.torque_range_n_mm);
        reported.torque_noise_n_mm = number(drive.torque_noise_n_mm);
        reported.torque_bias_n_mm = 10.0f;
        reported.angle_step_rad = number(drive.angle_step_rad);
        reported.angle_min_rad = -2.0f;
        reported.angle_max_rad = 3.0f;
        reported.takeup_torque_n_mm = 4000.0f;
    }
    p.limb.uncertainty = {number(kLength_mm), number(kAngle_rad), number(kCompliance_rel), number(kGain_rel)};
    p.gravity = {number(plant.gravity.femur_n), number(plant.gravity.tibia_n), number(plant.gravity.knee_n),
                 number(plant.gravity.direction_rad), number(plant.gravity.lean_rad)};
    p.sensor.noise_n = number(limb.force_noise_n);
    p.controller.node_id = node;
    p.controller.tick_us = 1000;
    p.controller.age_limit_us = 20000;
    return p;
}

// A limb that its calibration describes as well as it claims.
void differ(brace_plant_model_t &plant, Chance &chance)
{
    const auto off = [&chance] { return real(chance, -std::sqrt(3.0), std::sqrt(3.0)); };
    plant.geometry.femur_mm += kLength_mm * off();
    plant.geometry.tibia_mm += kLength_mm * off();
    const double gain = 1.0 + kGain_rel * off();
    for (int i = 0; i < BRACE_LINK_COUNT; ++i) {
        brace_plant_link_t &link = plant.link[i];
        for (double *compliance : {&link.axial_mm_per_n, &link.bending_mm_per_n, &link.lateral_mm_per_n,
                                   &plant.joint[i].compliance_rad_per_n_mm}) {
            *compliance *= gain * (1.0 + kCompliance_rel * off());
        }
        plant.joint[i].zero_offset_rad += i == 0 ? 0.0 : kAngle_rad * off();
    }
}

} // namespace

std::array<Limb, kLimbs> four_limbs(Chance &chance)
{
    std::array<Limb, kLimbs> limbs{};
    for (int i = 0; i < kLimbs; ++i) {
        Limb &limb = limbs[static_cast<std::size_t>(i)];
        limb.name = kSettings[i].name;
        limb.there = nominal(kSettings[i]);
        limb.believed = parameters_of(limb.there, static_cast<std::uint32_t>(i + 1));
        differ(limb.there.plant, chance);
        limb.there.modbus_tcp = "modbus-tcp://127.0.0.1:0";
    }
    return limbs;
}

} // namespace soak
