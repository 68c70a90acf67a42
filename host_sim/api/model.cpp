#include "api/checks.h"
#include "plant/model_keys.h"

extern "C" void brace_plant_model_default(brace_plant_model_t *model)
{
    if (model != nullptr) {
        *model = brace::plant::without_effects();
    }
}

extern "C" const char *brace_plant_model_fault(const brace_plant_model_t *model)
{
    return model != nullptr ? brace::plant::first_fault(*model) : nullptr;
}

extern "C" int64_t brace_plant_key_offset(const char *key)
{
    return key != nullptr ? brace::plant::key_offset(key) : -1;
}
