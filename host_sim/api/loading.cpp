#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

#include "api/checks.h"
#include "plant/loading.h"
#include "plant/model_keys.h"

namespace brace::api {

brace_host_status_t check_loading_rows(const brace_loading_rows_t &rows)
{
    const double *given[] = {rows.theta1_rad, rows.theta2_rad, rows.t_s, rows.dx_mm, rows.dz_mm};
    for (const double *column : given) {
        if (column == nullptr) {
            return BRACE_HOST_E_NULL;
        }
        if (!all_finite(column, rows.count)) {
            return BRACE_HOST_E_NOT_FINITE;
        }
    }
    if (rows.run == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    if ((rows.preload_x_n == nullptr) != (rows.preload_z_n == nullptr)) {
        return BRACE_HOST_E_NULL;
    }
    for (const double *column : {rows.temp_degc, rows.preload_x_n, rows.preload_z_n}) {
        if (!all_finite_if_given(column, rows.count)) {
            return BRACE_HOST_E_NOT_FINITE;
        }
    }
    for (size_t i = 0; rows.free_axis != nullptr && i < rows.count; ++i) {
        if (rows.free_axis[i] < 0 || rows.free_axis[i] > 2) {
            return BRACE_HOST_E_RANGE;
        }
    }
    return never_falls(rows.t_s, rows.count) ? BRACE_HOST_OK : BRACE_HOST_E_RANGE;
}

namespace {

constexpr double *brace_loading_reading_t::*kColumns[] = {
    &brace_loading_reading_t::fx_n,     &brace_loading_reading_t::fz_n,      &brace_loading_reading_t::enc1_rad,
    &brace_loading_reading_t::enc2_rad, &brace_loading_reading_t::base_x_mm, &brace_loading_reading_t::base_z_mm,
};

constexpr int32_t kNotPlayed = 1; // no status: those are 0 and below

bool rest_alike(const brace_plant_model_t &a, const brace_plant_model_t &b)
{
    brace_plant_model_t other = b;
    other.sensor = a.sensor;
    return std::memcmp(&a, &other, sizeof a) == 0;
}

brace_loading_reading_t part_of(const brace_loading_reading_t &whole, size_t offset)
{
    brace_loading_reading_t part{};
    for (const auto column : kColumns) {
        part.*column = whole.*column != nullptr ? whole.*column + offset : nullptr;
    }
    return part;
}

void fill_with_nan(const brace_loading_reading_t &reading, size_t count)
{
    for (const auto column : kColumns) {
        if (reading.*column != nullptr) {
            std::fill_n(reading.*column, count, std::numeric_limits<double>::quiet_NaN());
        }
    }
}

} // namespace
} // namespace brace::api

extern "C" int32_t brace_plant_loading(const brace_plant_model_t *model, const brace_loading_rows_t *rows,
                                       const brace_loading_reading_t *reading, size_t *unsolved_rows)
{
    if (model == nullptr || rows == nullptr || reading == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    const brace_host_status_t status = brace::api::check_loading_rows(*rows);
    if (status != BRACE_HOST_OK) {
        return status;
    }
    if (brace::plant::first_fault(*model) != nullptr) {
        return BRACE_HOST_E_PARAMETER;
    }
    size_t unsolved = 0;
    const brace_host_status_t played = brace::plant::Loading(*rows).play(*model, *reading, unsolved);
    if (unsolved_rows != nullptr && played != BRACE_HOST_E_SINGULAR) {
        *unsolved_rows = unsolved;
    }
    return played;
}

extern "C" int32_t brace_plant_loading_many(const brace_plant_model_t *models, size_t model_count,
                                            const brace_loading_rows_t *rows, const brace_loading_reading_t *readings,
                                            int32_t *status)
{
    if (models == nullptr || rows == nullptr || readings == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    const brace_host_status_t sound = brace::api::check_loading_rows(*rows);
    if (sound != BRACE_HOST_OK) {
        return sound;
    }
    brace::plant::Loading loading(*rows);
    std::vector<int32_t> outcome(model_count, brace::api::kNotPlayed);
    for (size_t m = 0; m < model_count; ++m) {
        if (outcome[m] != brace::api::kNotPlayed) {
            continue;
        }
        const bool sound_model = brace::plant::first_fault(models[m]) == nullptr;
        const bool rests = sound_model && loading.find_rests(models[m]);
        outcome[m] = sound_model ? BRACE_HOST_E_SINGULAR : BRACE_HOST_E_PARAMETER;
        // Limbs that differ by their sensors only rest alike.
        for (size_t n = m; rests && n < model_count; ++n) {
            const bool alike =
                n == m
                || (brace::api::rest_alike(models[m], models[n]) && brace::plant::first_fault(models[n]) == nullptr);
            if (alike) {
                const size_t unsolved = loading.read(models[n], brace::api::part_of(*readings, n * rows->count));
                outcome[n] = unsolved == 0 ? BRACE_HOST_OK : BRACE_HOST_E_NO_CONVERGENCE;
            }
        }
    }
    brace_host_status_t worst = BRACE_HOST_OK;
    for (size_t m = 0; m < model_count; ++m) {
        const auto one = static_cast<brace_host_status_t>(outcome[m]);
        if (one == BRACE_HOST_E_PARAMETER || one == BRACE_HOST_E_SINGULAR) {
            brace::api::fill_with_nan(brace::api::part_of(*readings, m * rows->count), rows->count);
        }
        if (status != nullptr) {
            status[m] = one;
        }
        worst = worst == BRACE_HOST_OK ? one : worst;
    }
    return worst;
}
