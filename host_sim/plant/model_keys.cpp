#include "plant/model_keys.h"

#include <cmath>
#include <cstring>

#include "plant/model_key_table.h"

namespace brace::plant {
namespace {

using effects::Model;

double value_of(const Model &model, const ModelKey &key)
{
    double value;
    std::memcpy(&value, reinterpret_cast<const char *>(&model) + key.offset, sizeof value);
    return value;
}

} // namespace

std::int64_t key_offset(std::string_view name)
{
    for (const ModelKey &key : kModelKeys) {
        if (name == key.name) {
            return static_cast<std::int64_t>(key.offset);
        }
    }
    return -1;
}

const char *first_fault(const Model &model)
{
    for (const ModelKey &key : kModelKeys) {
        const double value = value_of(model, key);
        const bool in_range = value >= key.least && value <= key.most; // false for NaN
        if (!in_range || (key.whole && value != std::floor(value))) {
            return key.name;
        }
    }
    return nullptr;
}

Model without_effects()
{
    Model model;
    for (const ModelKey &key : kModelKeys) {
        std::memcpy(reinterpret_cast<char *>(&model) + key.offset, &key.zero_effect, sizeof key.zero_effect);
    }
    return model;
}

} // namespace brace::plant
