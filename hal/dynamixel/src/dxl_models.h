/* The servos that the driver knows, and where their registers are. All of them share one control table. */
#ifndef DXL_MODELS_H
#define DXL_MODELS_H

#include <stdint.h>

typedef struct {
    uint16_t model;
    const char *name;
    float step_ma;       /* of the current's register */
    float n_mm_per_a;    /* stall torque / stall current at the nominal voltage, by the manual; the gear is in it */
} dxl_model_t;

/* null: unknown */
const dxl_model_t *dxl_model(uint16_t model);

enum {
    DXL_AT_IDENTITY = 0, /* model 2, information 4, firmware, id, baud rate, return delay, drive mode, mode */
    DXL_IDENTITY_BYTES = 12,
    DXL_AT_LIMITS = 38, /* current 2, 4 free, velocity 4, most position 4, least position 4 */
    DXL_LIMITS_BYTES = 18,
    DXL_AT_TORQUE = 64, /* torque, LED, 2 free, status return level, registered, hardware error */
    DXL_STATE_BYTES = 7,
    DXL_AT_GOAL_CURRENT = 102, /* current 2, velocity 4, profile 8, position 4 */
    DXL_GOALS_BYTES = 18,
    DXL_AT_GOAL_POSITION = 116,
    DXL_AT_PRESENT = 126, /* current 2, velocity 4, position 4 */
    DXL_PRESENT_BYTES = 10,
    DXL_AT_PRESENT_POSITION = 132,
    DXL_AT_TEMPERATURE = 146,
    DXL_MODE_POSITION = 3,
    DXL_MODE_CURRENT_POSITION = 5
};

#endif
