// A loading test played on a limb and read with the rig's instruments.
#pragma once

#include "effects/effect.h"

namespace brace::rig {

// Design and model must be sound; a null model leaves the readings 0.
brace_host_status_t play(const brace_rig_design_t &design, const effects::Model *model,
                         const brace_rig_record_t &record);

} // namespace brace::rig
