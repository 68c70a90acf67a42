#include "api/checks.h"
#include "effects/registry.h"
#include "plant/model_keys.h"

extern "C" void brace_plant_model_default(brace_plant_model_t *model)
{
    if (model != nullptr) {
        *model = brace::effects::without_any();
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

extern "C" size_t brace_effect_count(void)
{
    return brace::effects::count();
}

extern "C" int32_t brace_effect_at(size_t index, brace_effect_t *effect)
{
    if (effect == nullptr) {
        return BRACE_HOST_E_NULL;
    }
    const brace::effects::Entry *entry = brace::effects::at(index);
    if (entry == nullptr) {
        return BRACE_HOST_E_RANGE;
    }
    *effect = *entry;
    return BRACE_HOST_OK;
}
