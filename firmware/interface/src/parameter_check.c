#include <stdbool.h>
#include <stddef.h>

#include "brace/parameters.h"
#include "parameter_table.h"
#include "brace/words.h"

static brace_status_t float_in_range(uint32_t word, const float range[2])
{
    float value;
    memcpy(&value, &word, sizeof value);
    if (value >= range[0] && value <= range[1]) {
        return BRACE_OK;
    }
    return value != value ? BRACE_E_NOT_FINITE : BRACE_E_PARAMETER;
}

static bool chosen(uint32_t word, const uint32_t choices[BRACE_U32_LIST_MAX])
{
    for (uint32_t i = 0; i < BRACE_U32_LIST_MAX; i++) {
        if (word != 0u && word == choices[i]) {
            return true;
        }
    }
    return false;
}

static brace_status_t member_in_range(uint32_t word, uint32_t rule)
{
    if (rule < BRACE_F32_RANGES) {
        return float_in_range(word, brace_f32_range[rule]);
    }
    rule -= BRACE_F32_RANGES;
    if (rule < BRACE_U32_RANGES) {
        const uint32_t *range = brace_u32_range[rule];
        return word >= range[0] && word <= range[1] ? BRACE_OK : BRACE_E_PARAMETER;
    }
    return chosen(word, brace_u32_choices[rule - BRACE_U32_RANGES]) ? BRACE_OK : BRACE_E_PARAMETER;
}

brace_status_t brace_parameter_in_range(uint32_t index, uint32_t word)
{
    return index < BRACE_PARAMETER_COUNT ? member_in_range(word, brace_parameter_rule[index]) : BRACE_E_RANGE;
}

/* Do the members of a drive agree? returns the index of the member at fault, or BRACE_PARAMETER_COUNT. */
static uint32_t drive_fault(const brace_drive_t *drive, uint32_t first)
{
    const float range_n_mm = drive->torque_range_n_mm;
    const struct {
        bool wrong;
        uint8_t member; /* from the drive's first */
    } rule[] = {
        {drive->torque_noise_n_mm > range_n_mm, offsetof(brace_drive_t, torque_noise_n_mm) / 4},
        {drive->torque_bias_n_mm > range_n_mm, offsetof(brace_drive_t, torque_bias_n_mm) / 4},
        {drive->angle_max_rad <= drive->angle_min_rad, offsetof(brace_drive_t, angle_max_rad) / 4},
        {drive->takeup_torque_n_mm > range_n_mm, offsetof(brace_drive_t, takeup_torque_n_mm) / 4},
    };
    for (size_t i = 0; i < sizeof rule / sizeof *rule; i++) {
        if (rule[i].wrong) {
            return first + rule[i].member;
        }
    }
    return BRACE_PARAMETER_COUNT;
}

static uint32_t fault_between_members(const brace_parameters_t *parameters)
{
    uint32_t wrong = BRACE_PARAMETER_COUNT;
    for (uint32_t i = 0; i < BRACE_LINK_COUNT && wrong == BRACE_PARAMETER_COUNT; i++) {
        wrong = drive_fault(&parameters->drive[i], (uint32_t)(offsetof(brace_parameters_t, drive) / 4) +
                                                       i * (uint32_t)(sizeof(brace_drive_t) / 4));
    }
    const brace_controller_t *controller = &parameters->controller;
    if (wrong == BRACE_PARAMETER_COUNT && controller->age_limit_us < controller->tick_us) {
        wrong = BRACE_PARAMETER_CONTROLLER_AGE_LIMIT_US;
    }
    return wrong;
}

static brace_status_t refuse(brace_status_t status, uint32_t index, uint32_t *wrong_index)
{
    if (wrong_index != NULL) {
        *wrong_index = index;
    }
    return status;
}

static brace_status_t check_members(const brace_parameters_t *parameters, uint32_t from, uint32_t *wrong_index)
{
    const uint32_t end = from + BRACE_CHECK_MEMBERS < BRACE_PARAMETER_COUNT ? from + BRACE_CHECK_MEMBERS
                                                                            : (uint32_t)BRACE_PARAMETER_COUNT;
    for (uint32_t i = from; i < end; i++) { /* at most BRACE_CHECK_MEMBERS */
        const brace_status_t status = member_in_range(brace_member_get(parameters, i), brace_parameter_rule[i]);
        if (status != BRACE_OK) {
            return refuse(status, i, wrong_index);
        }
    }
    return BRACE_OK;
}

brace_status_t brace_parameters_check_piece(const brace_parameters_t *parameters, uint32_t piece, uint32_t *wrong_index)
{
    if (parameters == NULL) {
        return BRACE_E_NULL;
    }
    if (piece < BRACE_CHECK_TOGETHER) {
        return check_members(parameters, piece * BRACE_CHECK_MEMBERS, wrong_index);
    }
    if (piece > BRACE_CHECK_TOGETHER) {
        return BRACE_E_RANGE;
    }
    const uint32_t wrong = fault_between_members(parameters);
    if (wrong != BRACE_PARAMETER_COUNT) {
        return refuse(BRACE_E_PARAMETER, wrong, wrong_index);
    }
    const brace_status_t limb = brace_limb_check_together(&parameters->limb); /* its members were judged one by one */
    return limb == BRACE_OK ? BRACE_OK : refuse(limb, BRACE_PARAMETER_COUNT, wrong_index);
}

brace_status_t brace_parameters_check(const brace_parameters_t *parameters, uint32_t *wrong_index)
{
    brace_status_t status = BRACE_OK;
    for (uint32_t piece = 0; piece < BRACE_CHECK_PIECES && status == BRACE_OK; piece++) {
        status = brace_parameters_check_piece(parameters, piece, wrong_index);
    }
    return status;
}

void brace_parameters_default(brace_parameters_t *parameters)
{
    if (parameters != NULL) {
        *parameters = brace_parameters_safe;
    }
}
