// Four numbers at once, one each for four limbs: what the elimination does for one limb it does for four with the same
// instructions. No lane sees another, so each limb gets the bits that it gets alone.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <type_traits>

namespace brace::plant {

constexpr std::size_t kLanes = 4;

struct Lanes {
    using Four = double __attribute__((vector_size(kLanes * sizeof(double))));
    Four at;

    Lanes() = default;
    Lanes(double all) : at{all, all, all, all} {} // not explicit: a constant is the same in each lane
    explicit Lanes(const Four &each) : at(each) {}
    // The compiler's own copy goes through memory in halves, for which the next load waits. With a copy of its own it
    // is handed over in memory, too: functions for machines with and without wide registers may call each other.
    Lanes(const Lanes &b) : at(b.at) {}
    Lanes &operator=(const Lanes &b) { return at = b.at, *this; }

    Lanes &operator+=(const Lanes &b) { return at += b.at, *this; }
    Lanes &operator-=(const Lanes &b) { return at -= b.at, *this; }
    Lanes &operator*=(const Lanes &b) { return at *= b.at, *this; }
    friend Lanes operator+(const Lanes &a, const Lanes &b) { return Lanes(a.at + b.at); }
    friend Lanes operator-(const Lanes &a, const Lanes &b) { return Lanes(a.at - b.at); }
    friend Lanes operator*(const Lanes &a, const Lanes &b) { return Lanes(a.at * b.at); }
    friend Lanes operator/(const Lanes &a, const Lanes &b) { return Lanes(a.at / b.at); }
    friend Lanes operator-(const Lanes &a) { return Lanes(-a.at); }
};

static_assert(kLanes == 4, "constants, and is_there, name four lanes");
static_assert(!std::is_trivially_copyable_v<Lanes>, "it would be handed over in registers");

// What formulas for one limb or four need beside the arithmetic.
inline double larger(double a, double b)
{
    return std::max(a, b);
}
inline double magnitude(double a)
{
    return std::fabs(a);
}
inline double one_if_negative(double a)
{
    return a < 0.0 ? 1.0 : 0.0;
}
inline bool is_there(double a)
{
    return a != 0.0;
}

inline Lanes larger(const Lanes &a, const Lanes &b)
{
    return Lanes(a.at < b.at ? b.at : a.at);
}
inline Lanes magnitude(const Lanes &a)
{
    return Lanes(a.at > 0.0 ? a.at : 0.0 - a.at);
}
inline Lanes one_if_negative(const Lanes &a)
{
    return Lanes(a.at < 0.0 ? Lanes(1.0).at : Lanes(0.0).at);
}
inline bool is_there(const Lanes &a) // in any lane
{
    return a.at[0] != 0.0 || a.at[1] != 0.0 || a.at[2] != 0.0 || a.at[3] != 0.0;
}

// Sine and cosine by their series, of angles of at most kSeries_rad: what is left out is below a fiftieth of a
// rounding.
constexpr double kSeries_rad = 0.5;

template <class Number> void series(const Number &a, Number &sin, Number &cos)
{
    static constexpr double kSin[] = {-1.0 / 1307674368000.0, 1.0 / 6227020800.0, -1.0 / 39916800.0, 1.0 / 362880.0,
                                      -1.0 / 5040.0,          1.0 / 120.0,        -1.0 / 6.0};
    static constexpr double kCos[] = {
        -1.0 / 87178291200.0, 1.0 / 479001600.0, -1.0 / 3628800.0, 1.0 / 40320.0, -1.0 / 720.0, 1.0 / 24.0, -0.5};
    const Number square = a * a;
    Number by_sin = kSin[0], by_cos = kCos[0];
    for (std::size_t i = 1; i < std::size(kSin); ++i) {
        by_sin = by_sin * square + kSin[i];
        by_cos = by_cos * square + kCos[i];
    }
    sin = a + a * square * by_sin;
    cos = 1.0 + square * by_cos;
}

inline void sin_cos(double a, double &sin, double &cos)
{
    if (std::fabs(a) <= kSeries_rad) {
        series(a, sin, cos);
    } else {
        sin = std::sin(a);
        cos = std::cos(a);
    }
}

inline void sin_cos(const Lanes &a, Lanes &sin, Lanes &cos)
{
    series(a, sin, cos);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (!(std::fabs(a.at[lane]) <= kSeries_rad)) {
            sin.at[lane] = std::sin(a.at[lane]);
            cos.at[lane] = std::cos(a.at[lane]);
        }
    }
}

} // namespace brace::plant

template <> struct Eigen::NumTraits<brace::plant::Lanes> : Eigen::GenericNumTraits<brace::plant::Lanes> {
    enum { RequireInitialization = 0, ReadCost = 1, AddCost = 1, MulCost = 1 };
};
