#include "plant/model_keys.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace brace::plant {
namespace {

using effects::Model;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kMost = std::numeric_limits<double>::max();
constexpr double kTiny = std::numeric_limits<double>::min();
constexpr double kQuarterTurn = 1.5707963267948966;

struct Key {
    const char *name;
    std::size_t offset;
    double least;
    double most;
};

#define LINK_KEYS(table, index)                                                                           \
    {"link." table ".axial_mm_per_n", offsetof(Model, link[index].axial_mm_per_n), 0.0, 1e3},             \
        {"link." table ".bending_mm_per_n", offsetof(Model, link[index].bending_mm_per_n), 0.0, 1e3},     \
        {"link." table ".tilt_rad", offsetof(Model, link[index].tilt_rad), -kQuarterTurn, kQuarterTurn},  \
        {"link." table ".moment_transfer", offsetof(Model, link[index].moment_transfer_ratio), 0.0, 1.0}, \
        {"link." table ".lateral_mm_per_n", offsetof(Model, link[index].lateral_mm_per_n), 0.0, 1e3},     \
        {"link." table ".torsion_rad_per_n_mm", offsetof(Model, link[index].torsion_rad_per_n_mm), 0.0, 1.0}

#define JOINT_KEYS(table, index)                                                                            \
    {"joint." table ".compliance_rad_per_n_mm", offsetof(Model, joint[index].compliance_rad_per_n_mm), 0.0, \
     1.0},                                                                                                  \
        {"joint." table ".gap_rad", offsetof(Model, joint[index].gap_rad), 0.0, 0.5},                       \
        {"joint." table ".coulomb_n_mm", offsetof(Model, joint[index].coulomb_n_mm), 0.0, 1e9},             \
        {"joint." table ".hardening_n_mm_per_rad3", offsetof(Model, joint[index].hardening_n_mm_per_rad3),  \
         0.0, 1e30},                                                                                        \
        {"joint." table ".zero_offset_rad", offsetof(Model, joint[index].zero_offset_rad), -0.5, 0.5}

constexpr Key kKeys[] = {
    {"geometry.coxa_mm", offsetof(Model, geometry.coxa_mm), 0.0, 1e4},
    {"geometry.femur_mm", offsetof(Model, geometry.femur_mm), 1.0, 1e4},
    {"geometry.tibia_mm", offsetof(Model, geometry.tibia_mm), 1.0, 1e4},
    LINK_KEYS("coxa", 0),
    LINK_KEYS("femur", 1),
    LINK_KEYS("tibia", 2),
    JOINT_KEYS("coxa", 0),
    JOINT_KEYS("femur", 1),
    JOINT_KEYS("tibia", 2),
    {"base.x_mm_per_n", offsetof(Model, base.x_mm_per_n), 0.0, 1e3},
    {"base.z_mm_per_n", offsetof(Model, base.z_mm_per_n), 0.0, 1e3},
    {"base.rotation_rad_per_n_mm", offsetof(Model, base.rotation_rad_per_n_mm), 0.0, 1.0},
    {"gravity.femur_n", offsetof(Model, gravity.femur_n), 0.0, 1e6},
    {"gravity.tibia_n", offsetof(Model, gravity.tibia_n), 0.0, 1e6},
    {"gravity.knee_n", offsetof(Model, gravity.knee_n), 0.0, 1e6},
    {"sensor.bias_x_n", offsetof(Model, sensor.bias_x_n), -1e6, 1e6},
    {"sensor.bias_z_n", offsetof(Model, sensor.bias_z_n), -1e6, 1e6},
    {"sensor.gain", offsetof(Model, sensor.gain), kTiny, 1e3},
    {"sensor.rotation_rad", offsetof(Model, sensor.rotation_rad), -4.0, 4.0},
    {"sensor.crosstalk_xz", offsetof(Model, sensor.crosstalk_xz), -10.0, 10.0},
    {"sensor.crosstalk_zx", offsetof(Model, sensor.crosstalk_zx), -10.0, 10.0},
    {"sensor.drift_x_n_per_s", offsetof(Model, sensor.drift_x_n_per_s), -1e6, 1e6},
    {"sensor.drift_z_n_per_s", offsetof(Model, sensor.drift_z_n_per_s), -1e6, 1e6},
    {"sensor.saturation_n", offsetof(Model, sensor.saturation_n), kTiny, kInf},
    {"creep.ratio", offsetof(Model, creep.ratio), 0.0, 1e3},
    {"creep.time_constant_s", offsetof(Model, creep.time_constant_s), kTiny, kMost},
    {"thermal.joint_compliance_per_degc", offsetof(Model, thermal.joint_compliance_per_degc), -10.0, 10.0},
    {"thermal.reference_degc", offsetof(Model, thermal.reference_degc), -273.15, 1e4},
    {"contact.play_mm", offsetof(Model, contact.play_mm), 0.0, 1e3},
    {"change.at_s", offsetof(Model, change.at_s), -kMost, kInf},
    {"change.link", offsetof(Model, change.link_index), 0.0, 2.0},
    {"change.bending_factor", offsetof(Model, change.bending_factor), 0.0, 1e3},
};

#undef LINK_KEYS
#undef JOINT_KEYS

double value_of(const Model &model, const Key &key)
{
    double value;
    std::memcpy(&value, reinterpret_cast<const char *>(&model) + key.offset, sizeof value);
    return value;
}

} // namespace

std::int64_t key_offset(std::string_view name)
{
    for (const Key &key : kKeys) {
        if (name == key.name) {
            return static_cast<std::int64_t>(key.offset);
        }
    }
    return -1;
}

const char *first_fault(const Model &model)
{
    for (const Key &key : kKeys) {
        const double value = value_of(model, key);
        if (!(value >= key.least && value <= key.most)) { // NaN is neither
            return key.name;
        }
    }
    const double link = model.change.link_index;
    return link == std::floor(link) ? nullptr : "change.link";
}

} // namespace brace::plant
