#include "dxl_models.h"

#include <stddef.h>

#include "brace_dynamixel.h"
#include "dxl_model_table.h"

static const dxl_model_t models[] = {DXL_MODEL_TABLE};

const dxl_model_t *dxl_model(uint16_t model)
{
    for (uint32_t i = 0; i < sizeof models / sizeof models[0]; i++) { /* ten */
        if (models[i].model == model) {
            return &models[i];
        }
    }
    return NULL;
}

const char *brace_dynamixel_name(uint16_t model)
{
    const dxl_model_t *known = dxl_model(model);
    return known != NULL ? known->name : NULL;
}
