/* The force of the ground on the tip, read from the tip's sensor and corrected. */
#ifndef BRACE_SENSE_TIP_FORCE_H
#define BRACE_SENSE_TIP_FORCE_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/parameters.h"
#include "brace_hal.h"

typedef struct {
    bool known;        /* x_n, z_n are no older than controller.age_limit_us */
    uint32_t age_us;   /* since the sensor last gave a new reading */
    float x_n, z_n;    /* [N], in the limb's plane; valid while known */
    bool fitted;       /* there is a sensor, and its matrix has an inverse; this and inverse stay as configured */
    float inverse[4];  /* from a reading less its bias to the force; rows x, z */
} tip_force_t;

/* Prepares the correction when parameters are put in force. No reading is known afterwards. About 200 instructions. */
void tip_force_configure(tip_force_t *force, const brace_hal_t *hal, const brace_sensor_t *sensor);

/* Reads and corrects the sensor. Bias, gain, rotation and cross-talk are undone. Drift is not, because nobody on the
 * limb knows when the sensor was zeroed. A saturated reading is not known, nor one older than
 * controller.age_limit_us. since_us: since it was last called, which a late tick makes longer. */
void tip_force_read(tip_force_t *force, const brace_hal_t *hal, const brace_parameters_t *parameters,
                    uint32_t since_us);

#endif
