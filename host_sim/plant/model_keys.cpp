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

// clang-format off
#define KEY(name, member, least, most) {name, offsetof(Model, member), least, most}

#define LINK_KEYS(table, index)                                                                          \
    KEY("link." table ".axial_mm_per_n", link[index].axial_mm_per_n, 0.0, 1e3),                          \
    KEY("link." table ".bending_mm_per_n", link[index].bending_mm_per_n, 0.0, 1e3),                      \
    KEY("link." table ".tilt_rad", link[index].tilt_rad, -kQuarterTurn, kQuarterTurn),                   \
    KEY("link." table ".moment_transfer", link[index].moment_transfer_ratio, 0.0, 1.0),                  \
    KEY("link." table ".lateral_mm_per_n", link[index].lateral_mm_per_n, 0.0, 1e3),                      \
    KEY("link." table ".torsion_rad_per_n_mm", link[index].torsion_rad_per_n_mm, 0.0, 1.0)

#define JOINT_KEYS(table, index)                                                                         \
    KEY("joint." table ".compliance_rad_per_n_mm", joint[index].compliance_rad_per_n_mm, 0.0, 1.0),      \
    KEY("joint." table ".gap_rad", joint[index].gap_rad, 0.0, 0.5),                                      \
    KEY("joint." table ".coulomb_n_mm", joint[index].coulomb_n_mm, 0.0, 1e9),                            \
    KEY("joint." table ".coulomb_per_load_ratio", joint[index].coulomb_per_load_ratio, 0.0, 0.9),        \
    KEY("joint." table ".hardening_n_mm_per_rad3", joint[index].hardening_n_mm_per_rad3, 0.0, 1e30),     \
    KEY("joint." table ".zero_offset_rad", joint[index].zero_offset_rad, -0.5, 0.5)

constexpr Key kKeys[] = {
    KEY("geometry.coxa_mm", geometry.coxa_mm, 0.0, 1e4),
    KEY("geometry.femur_mm", geometry.femur_mm, 1.0, 1e4),
    KEY("geometry.tibia_mm", geometry.tibia_mm, 1.0, 1e4),
    LINK_KEYS("coxa", 0),
    LINK_KEYS("femur", 1),
    LINK_KEYS("tibia", 2),
    JOINT_KEYS("coxa", 0),
    JOINT_KEYS("femur", 1),
    JOINT_KEYS("tibia", 2),
    KEY("base.x_mm_per_n", base.x_mm_per_n, 0.0, 1e3),
    KEY("base.z_mm_per_n", base.z_mm_per_n, 0.0, 1e3),
    KEY("base.rotation_rad_per_n_mm", base.rotation_rad_per_n_mm, 0.0, 1.0),
    KEY("gravity.femur_n", gravity.femur_n, 0.0, 1e6),
    KEY("gravity.tibia_n", gravity.tibia_n, 0.0, 1e6),
    KEY("gravity.knee_n", gravity.knee_n, 0.0, 1e6),
    KEY("sensor.bias_x_n", sensor.bias_x_n, -1e6, 1e6),
    KEY("sensor.bias_z_n", sensor.bias_z_n, -1e6, 1e6),
    KEY("sensor.gain", sensor.gain, kTiny, 1e3),
    KEY("sensor.rotation_rad", sensor.rotation_rad, -4.0, 4.0),
    KEY("sensor.crosstalk_xz", sensor.crosstalk_xz, -10.0, 10.0),
    KEY("sensor.crosstalk_zx", sensor.crosstalk_zx, -10.0, 10.0),
    KEY("sensor.drift_x_n_per_s", sensor.drift_x_n_per_s, -1e6, 1e6),
    KEY("sensor.drift_z_n_per_s", sensor.drift_z_n_per_s, -1e6, 1e6),
    KEY("sensor.saturation_n", sensor.saturation_n, kTiny, kInf),
    KEY("creep.ratio", creep.ratio, 0.0, 1e3),
    KEY("creep.time_constant_s", creep.time_constant_s, kTiny, kMost),
    KEY("thermal.joint_compliance_per_degc", thermal.joint_compliance_per_degc, -10.0, 10.0),
    KEY("thermal.reference_degc", thermal.reference_degc, -273.15, 1e4),
    KEY("contact.play_mm", contact.play_mm, 0.0, 1e3),
    KEY("change.at_s", change.at_s, -kMost, kInf),
    KEY("change.link", change.link_index, 0.0, 2.0),
    KEY("change.bending_factor", change.bending_factor, 0.0, 1e3),
};

#undef KEY
#undef LINK_KEYS
#undef JOINT_KEYS
// clang-format on

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
