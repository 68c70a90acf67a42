#include "rig/record.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "plant/loading.h"
#include "rig/noise.h"
#include "rig/sequence.h"

namespace brace::rig {
namespace {

// The record's inputs as columns.
struct Columns {
    explicit Columns(const std::vector<Reading> &readings)
    {
        for (const Reading &each : readings) {
            run.push_back(each.run);
            theta1.push_back(each.theta1_rad);
            theta2.push_back(each.theta2_rad);
            t.push_back(each.t_s);
            temp.push_back(each.temp_degc);
            dx.push_back(each.dx_mm);
            dz.push_back(each.dz_mm);
            free_axis.push_back(2 - each.axis);
        }
    }

    brace_loading_rows_t rows(const brace_rig_design_t &design) const
    {
        brace_loading_rows_t result{};
        result.count = run.size();
        result.run = run.data();
        result.theta1_rad = theta1.data();
        result.theta2_rad = theta2.data();
        result.t_s = t.data();
        result.temp_degc = temp.data();
        result.dx_mm = dx.data();
        result.dz_mm = dz.data();
        result.free_axis = design.transverse_free != 0 ? free_axis.data() : nullptr;
        result.small_displacements = design.small_displacements;
        result.held_at_rest = design.held_at_rest;
        return result;
    }

    std::vector<int32_t> run, free_axis;
    std::vector<double> theta1, theta2, t, temp, dx, dz;
};

double rounded(double value, double resolution)
{
    return resolution > 0.0 ? resolution * std::nearbyint(value / resolution) : value;
}

double instrument_n(const brace_rig_design_t &design, double force_n, Noise &noise)
{
    const double noisy = force_n + design.noise_n * noise.normal();
    return rounded(std::clamp(noisy, -design.range_n, design.range_n), design.resolution_n);
}

template <typename T, typename V> void write(T *column, std::size_t row, V value)
{
    if (column != nullptr) {
        column[row] = static_cast<T>(value);
    }
}

} // namespace

brace_host_status_t play(const brace_rig_design_t &design, const effects::Model *model,
                         const brace_rig_record_t &record)
{
    const std::vector<Reading> readings = sequence(design);
    const Columns columns(readings);
    const std::size_t count = readings.size();
    std::vector<double> fx(count), fz(count), enc1(count), enc2(count), base_x(count), base_z(count);
    brace_host_status_t status = BRACE_HOST_OK;
    if (model != nullptr) {
        const brace_loading_rows_t rows = columns.rows(design);
        const brace_loading_reading_t reading{fx.data(),   fz.data(),     enc1.data(),
                                              enc2.data(), base_x.data(), base_z.data()};
        std::size_t unsolved = 0;
        status = plant::Loading(rows).play(*model, reading, unsolved);
        if (status == BRACE_HOST_E_SINGULAR) {
            return status;
        }
    }

    Noise noise(design.seed);
    double zero_x = 0.0;
    double zero_z = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const Reading &each = readings[i];
        // Every instrument draws its noise for every row, whether its column is asked for or not. So the columns asked
        // for do not change one another.
        double read_x = instrument_n(design, fx[i], noise);
        double read_z = instrument_n(design, fz[i], noise);
        const double read_enc1 = enc1[i] + design.encoder_noise_rad * noise.normal();
        const double read_enc2 = enc2[i] + design.encoder_noise_rad * noise.normal();
        const double read_base_x = base_x[i] + design.base_noise_mm * noise.normal();
        const double read_base_z = base_z[i] + design.base_noise_mm * noise.normal();
        if (design.zeroed != 0 && each.step == 0) {
            zero_x = read_x;
            zero_z = read_z;
        }
        read_x -= zero_x;
        read_z -= zero_z;
        write(record.run, i, each.run);
        write(record.config, i, each.config);
        write(record.axis, i, each.axis);
        write(record.rep, i, each.rep);
        write(record.step, i, each.step);
        write(record.theta1_rad, i, each.theta1_rad);
        write(record.theta2_rad, i, each.theta2_rad);
        write(record.t_s, i, each.t_s);
        write(record.temp_degc, i, each.temp_degc);
        write(record.dx_mm, i, each.dx_mm);
        write(record.dz_mm, i, each.dz_mm);
        write(record.fx_n, i, read_x);
        write(record.fz_n, i, read_z);
        write(record.enc1_rad, i, read_enc1);
        write(record.enc2_rad, i, read_enc2);
        write(record.base_x_mm, i, read_base_x);
        write(record.base_z_mm, i, read_base_z);
    }
    return status;
}

} // namespace brace::rig
