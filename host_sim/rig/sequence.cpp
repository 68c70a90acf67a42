#include "rig/sequence.h"

#include <cmath>
#include <utility>

#include "rig/noise.h"

namespace brace::rig {
namespace {

constexpr std::size_t kMostReadings = 20000000;

struct Run {
    int config, axis, rep;
};

void sweep(std::vector<int> &steps, int to)
{
    while (steps.back() != to) {
        steps.push_back(steps.back() + (to > steps.back() ? 1 : -1));
    }
}

std::vector<Run> runs_of(const brace_rig_design_t &design)
{
    std::vector<Run> runs;
    for (std::size_t config = 0; config < design.config_count; ++config) {
        for (const int axis : {0, 1}) {
            for (int rep = 1; (design.axes >> axis & 1) != 0 && rep <= design.repeats; ++rep) {
                runs.push_back({static_cast<int>(config) + 1, axis, rep});
            }
        }
    }
    if (design.shuffled != 0) {
        // The order has a random stream of its own, so that it does not depend on how much noise is drawn.
        Noise order(design.seed ^ 0xA5A5A5A5A5A5A5A5u);
        for (std::size_t left = runs.size(); left > 1; --left) {
            std::swap(runs[left - 1], runs[order.below(left)]);
        }
    }
    return runs;
}

double temperature(const brace_rig_design_t &design, double t_s)
{
    const double since_s = t_s - design.start_s;
    return design.temp_start_degc - design.temp_rise_degc * std::expm1(-since_s / design.temp_time_constant_s);
}

bool is_between(double value, double least, double most)
{
    return value >= least && value <= most; // false for NaN
}

} // namespace

brace_rig_design_t paper_design()
{
    brace_rig_design_t design{};
    design.axes = 3;
    design.repeats = 2;
    design.steps_per_side = 4;
    design.step_mm = 0.635;
    design.dwell_s = 4.0;
    design.pause_s = 20.0;
    design.temp_start_degc = 22.0;
    design.temp_time_constant_s = 600.0;
    design.resolution_n = 0.0625;
    design.range_n = 145.0;
    return design;
}

std::vector<int> run_steps(int steps_per_side, bool cyclic)
{
    std::vector<int> steps{0};
    if (cyclic) {
        // Fig. 12: first to the negative side, then all the way up and back down.
        sweep(steps, -steps_per_side);
        sweep(steps, steps_per_side);
        sweep(steps, -steps_per_side);
    } else {
        sweep(steps, steps_per_side);
        sweep(steps, -steps_per_side);
    }
    sweep(steps, 0);
    return steps;
}

bool is_sound(const brace_rig_design_t &design)
{
    if (design.config_count == 0 || design.theta1_rad == nullptr || design.theta2_rad == nullptr) {
        return false;
    }
    for (std::size_t i = 0; i < design.config_count; ++i) {
        if (!std::isfinite(design.theta1_rad[i]) || !std::isfinite(design.theta2_rad[i])) {
            return false;
        }
    }
    constexpr double kFar = 1e3;
    constexpr double kLong = 1e6;
    constexpr double kLast = 1e9;
    return is_between(design.axes, 1, 3) && is_between(design.repeats, 1, 1000)
           && is_between(design.steps_per_side, 1, 10000) && design.step_mm > 0.0 && design.step_mm <= 100.0
           && is_between(design.preload_x_mm, -kFar, kFar) && is_between(design.preload_z_mm, -kFar, kFar)
           && is_between(design.start_s, 0.0, kLast) && is_between(design.dwell_s, 0.0, kLong)
           && is_between(design.pause_s, 0.0, kLong) && is_between(design.temp_start_degc, -273.15, 1e4)
           && is_between(design.temp_rise_degc, -1e4, 1e4) && design.temp_time_constant_s > 0.0
           && std::isfinite(design.temp_time_constant_s) && is_between(design.noise_n, 0.0, kLong)
           && is_between(design.resolution_n, 0.0, kLong) && design.range_n > 0.0
           && is_between(design.encoder_noise_rad, 0.0, kLong) && is_between(design.base_noise_mm, 0.0, kLong)
           && reading_count(design) <= kMostReadings;
}

std::size_t reading_count(const brace_rig_design_t &design)
{
    const std::size_t axes = (design.axes & 1) + (design.axes >> 1 & 1);
    const std::size_t sweeps = design.cyclic != 0 ? 6 : 4;
    const std::size_t per_run = sweeps * static_cast<std::size_t>(design.steps_per_side) + 1;
    return design.config_count * axes * static_cast<std::size_t>(design.repeats) * per_run;
}

std::vector<Reading> sequence(const brace_rig_design_t &design)
{
    const std::vector<int> steps = run_steps(design.steps_per_side, design.cyclic != 0);
    std::vector<Reading> readings;
    readings.reserve(reading_count(design));
    int number = 0;
    double t_s = design.start_s;
    for (const Run &run : runs_of(design)) {
        t_s += number > 0 ? design.dwell_s + design.pause_s : 0.0;
        ++number;
        for (std::size_t i = 0; i < steps.size(); ++i) {
            t_s += i > 0 ? design.dwell_s : 0.0;
            const double along_mm = steps[i] * design.step_mm;
            readings.push_back({number, run.config, run.axis, run.rep, static_cast<int>(i),
                                design.theta1_rad[run.config - 1], design.theta2_rad[run.config - 1], t_s,
                                temperature(design, t_s), design.preload_x_mm + (run.axis == 0 ? along_mm : 0.0),
                                design.preload_z_mm + (run.axis == 1 ? along_mm : 0.0)});
        }
    }
    return readings;
}

} // namespace brace::rig
