// Four numbers at once, one each for four limbs: what the elimination does for one limb it does for four with the same
// instructions. No lane sees another, so each limb gets the bits that it gets alone.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace brace::plant {

constexpr std::size_t kLanes = 4;

struct Lanes {
    using Four = double __attribute__((vector_size(kLanes * sizeof(double))));
    Four at;

    Lanes() = default;
    Lanes(double all) : at{all, all, all, all} {} // not explicit: a constant is the same in each lane
    explicit Lanes(const Four &each) : at(each) {}
    // The compiler's own copy goes through memory in halves, for which the next load waits.
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

// What formulas for one limb or four need beside the arithmetic.
inline double sin_of(double a) { return std::sin(a); }
inline double cos_of(double a) { return std::cos(a); }
inline double larger(double a, double b) { return std::max(a, b); }
inline double magnitude(double a) { return std::fabs(a); }
inline double one_if_negative(double a) { return a < 0.0 ? 1.0 : 0.0; }
inline bool is_there(double a) { return a != 0.0; }

inline Lanes sin_of(const Lanes &a)
{
    return Lanes(Lanes::Four{std::sin(a.at[0]), std::sin(a.at[1]), std::sin(a.at[2]), std::sin(a.at[3])});
}
inline Lanes cos_of(const Lanes &a)
{
    return Lanes(Lanes::Four{std::cos(a.at[0]), std::cos(a.at[1]), std::cos(a.at[2]), std::cos(a.at[3])});
}
inline Lanes larger(const Lanes &a, const Lanes &b) { return Lanes(a.at < b.at ? b.at : a.at); }
inline Lanes magnitude(const Lanes &a) { return Lanes(a.at < 0.0 ? -a.at : a.at); }
inline Lanes one_if_negative(const Lanes &a) { return Lanes(a.at < 0.0 ? Lanes(1.0).at : Lanes(0.0).at); }
inline bool is_there(const Lanes &a) // in any lane
{
    return a.at[0] != 0.0 || a.at[1] != 0.0 || a.at[2] != 0.0 || a.at[3] != 0.0;
}

} // namespace brace::plant

template <>
struct Eigen::NumTraits<brace::plant::Lanes> : Eigen::GenericNumTraits<brace::plant::Lanes> {
    enum { RequireInitialization = 0, ReadCost = 1, AddCost = 1, MulCost = 1 };
};
