// Rest states of one run by where the tip is held. A run leads the tip to few places, and to most of them twice.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "plant/shape.h"

namespace brace::plant {

template <int N, class Rest> class KnownRests {
public:
    void clear() { count_ = 0; }

    // null: none is known.
    const Rest *at(const Vector<N> &target_mm, int free_axis) const
    {
        const auto end = known_.begin() + count_;
        const auto found = std::find_if(known_.begin(), end, [&](const Known &known) {
            return known.target_mm == target_mm && known.free_axis == free_axis;
        });
        return found != end ? &found->rest : nullptr;
    }

    // Keeps the first ones.
    void add(const Vector<N> &target_mm, int free_axis, const Rest &rest)
    {
        if (count_ < kMost) {
            known_[static_cast<std::size_t>(count_++)] = {target_mm, free_axis, rest};
        }
    }

private:
    struct Known {
        Vector<N> target_mm;
        int free_axis;
        Rest rest;
    };
    static constexpr int kMost = 20; // places of 9 steps to each side
    std::array<Known, kMost> known_;
    int count_ = 0;
};

} // namespace brace::plant
