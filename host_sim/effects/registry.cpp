#include "effects/registry.h"

#include "effects/backlash.h"
#include "effects/base_compliance.h"
#include "effects/contact_play.h"
#include "effects/coulomb_friction.h"
#include "effects/creep.h"
#include "effects/gravity.h"
#include "effects/joint_compliance.h"
#include "effects/joint_hardening.h"
#include "effects/joint_zero_offset.h"
#include "effects/link_change.h"
#include "effects/link_compliance_error.h"
#include "effects/link_length_error.h"
#include "effects/moment_transfer.h"
#include "effects/sensor_bias.h"
#include "effects/sensor_crosstalk.h"
#include "effects/sensor_drift.h"
#include "effects/sensor_gain.h"
#include "effects/sensor_rotation.h"
#include "effects/sensor_saturation.h"
#include "effects/thermal_softening.h"

namespace brace::effects {
namespace {

struct Range {
    const Entry *first;
    std::size_t count;
};

template <std::size_t N>
constexpr Range range(const Entry (&entries)[N])
{
    return {entries, N};
}

constexpr Range kRanges[] = {
    range(joint_compliance::kEntries),
    range(moment_transfer::kEntries),
    range(base_compliance::kEntries),
    range(link_compliance_error::kEntries),
    range(link_change::kEntries),
    range(backlash::kEntries),
    range(coulomb_friction::kEntries),
    range(joint_hardening::kEntries),
    range(creep::kEntries),
    range(thermal_softening::kEntries),
    range(gravity::kEntries),
    range(joint_zero_offset::kEntries),
    range(link_length_error::kEntries),
    range(sensor_bias::kEntries),
    range(sensor_drift::kEntries),
    range(sensor_gain::kEntries),
    range(sensor_rotation::kEntries),
    range(sensor_crosstalk::kEntries),
    range(sensor_saturation::kEntries),
    range(contact_play::kEntries),
};

} // namespace

std::size_t count()
{
    std::size_t total = 0;
    for (const Range &each : kRanges) {
        total += each.count;
    }
    return total;
}

const Entry *at(std::size_t index)
{
    for (const Range &each : kRanges) {
        if (index < each.count) {
            return each.first + index;
        }
        index -= each.count;
    }
    return nullptr;
}

Model without_any()
{
    Model model{};
    link_compliance_error::none(model);
    joint_compliance::none(model);
    moment_transfer::none(model);
    base_compliance::none(model);
    link_change::none(model);
    backlash::none(model);
    coulomb_friction::none(model);
    joint_hardening::none(model);
    creep::none(model);
    thermal_softening::none(model);
    gravity::none(model);
    joint_zero_offset::none(model);
    link_length_error::none(model);
    sensor_bias::none(model);
    sensor_drift::none(model);
    sensor_gain::none(model);
    sensor_rotation::none(model);
    sensor_crosstalk::none(model);
    sensor_saturation::none(model);
    contact_play::none(model);
    return model;
}

} // namespace brace::effects
