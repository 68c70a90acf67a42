#include "brace/recorder.h"

#include <stddef.h>

void brace_recorder_add(brace_recorder_t *recorder, const brace_row_t *row)
{
    recorder->row[recorder->next] = *row;
    recorder->next = recorder->next + 1u < BRACE_RECORDER_ROWS ? recorder->next + 1u : 0u;
    if (recorder->count < BRACE_RECORDER_ROWS) {
        recorder->count++;
    } else {
        recorder->lost += recorder->lost < UINT32_MAX;
    }
}

brace_status_t brace_recorder_row(const brace_recorder_t *recorder, uint32_t index, brace_row_t *row)
{
    if (recorder == NULL || row == NULL) {
        return BRACE_E_NULL;
    }
    if (index >= recorder->count) {
        return BRACE_E_RANGE;
    }
    const uint32_t at = recorder->next + BRACE_RECORDER_ROWS - recorder->count + index;
    *row = recorder->row[at % BRACE_RECORDER_ROWS];
    return BRACE_OK;
}

brace_status_t brace_row_value(const brace_row_t *row, uint32_t column, float *value)
{
    if (row == NULL || value == NULL) {
        return BRACE_E_NULL;
    }
    switch (column) {
    case 0: *value = row->run; break;
    case 1: *value = row->config; break;
    case 2: *value = row->theta1_rad; break;
    case 3: *value = row->theta2_rad; break;
    case 4: *value = row->axis; break;
    case 5: *value = row->rep; break;
    case 6: *value = row->step; break;
    case 7: *value = row->t_s; break;
    case 8: *value = row->temp_degc; break;
    case 9: *value = row->dx_mm; break;
    case 10: *value = row->dz_mm; break;
    case 11: *value = row->fx_n; break;
    case 12: *value = row->fz_n; break;
    case 13: *value = row->enc1_rad; break;
    case 14: *value = row->enc2_rad; break;
    default: return BRACE_E_RANGE;
    }
    return BRACE_OK;
}
