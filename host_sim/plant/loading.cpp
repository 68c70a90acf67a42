#include "plant/loading.h"

#include "plant/limb_state.h"
#include "plant/sensor.h"

namespace brace::plant {

using Eigen::Vector2d;

brace_host_status_t play_loading(const effects::Model &model, const brace_loading_rows_t &rows,
                                 const brace_loading_reading_t &reading, std::size_t &unsolved_rows)
{
    const Displacements displacements =
        rows.small_displacements != 0 ? Displacements::small : Displacements::finite;
    // Checks all poses first, so that a refused record leaves nothing half-written.
    for (std::size_t i = 0; i < rows.count; ++i) {
        if (i > 0 && rows.theta1_rad[i] == rows.theta1_rad[i - 1]
            && rows.theta2_rad[i] == rows.theta2_rad[i - 1]) {
            continue;
        }
        LimbState probe(model, displacements);
        if (!probe.move_to(rows.theta1_rad[i], rows.theta2_rad[i], rows.t_s[i],
                           model.thermal.reference_degc)) {
            return BRACE_HOST_E_SINGULAR;
        }
    }

    LimbState limb(model, displacements);
    Vector2d zero_n = Vector2d::Zero();
    unsolved_rows = 0;
    for (std::size_t i = 0; i < rows.count; ++i) {
        const bool starts_run = i == 0 || rows.run[i] != rows.run[i - 1];
        bool solved = true;
        const double temp = rows.temp_degc != nullptr ? rows.temp_degc[i] : model.thermal.reference_degc;
        limb.move_to(rows.theta1_rad[i], rows.theta2_rad[i], rows.t_s[i], temp);
        if (starts_run) {
            limb.start_run(rows.creep_runs_on == 0);
            solved = rows.held_at_rest == 0 || limb.hang();
        }
        const LimbRest rest =
            limb.hold_tip({rows.dx_mm[i], rows.dz_mm[i]}, rows.free_axis != nullptr ? rows.free_axis[i] : 0);
        unsolved_rows += solved && rest.solved ? 0 : 1;
        Vector2d read_n = sensor_reading_n(model, rest.force_n, rows.t_s[i]);
        if (starts_run) {
            zero_n = rows.zeroed_per_run != 0 ? read_n : Vector2d::Zero();
        }
        read_n -= zero_n;
        const auto write = [i](double *column, double value) {
            if (column != nullptr) {
                column[i] = value;
            }
        };
        write(reading.fx_n, read_n.x());
        write(reading.fz_n, read_n.y());
        write(reading.enc1_rad, rest.joint_deflection_rad[0]);
        write(reading.enc2_rad, rest.joint_deflection_rad[1]);
        write(reading.base_x_mm, rest.base_mm.x());
        write(reading.base_z_mm, rest.base_mm.y());
    }
    return unsolved_rows == 0 ? BRACE_HOST_OK : BRACE_HOST_E_NO_CONVERGENCE;
}

} // namespace brace::plant
