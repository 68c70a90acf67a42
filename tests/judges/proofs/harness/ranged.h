/* Integers that stand for all that a word may hold: the firmware's own text, run once, then shows whether any of its
 * numbers leaves its word.
 *
 * What it does. A `word` stands for an int32_t, uint32_t, int64_t or uint64_t of the firmware and knows the least and
 * the largest number that it may hold. The firmware's headers are included into a namespace in which these four names
 * mean such words, so that their text is what is run. A sum, product or shift makes a new word with the range that
 * follows. Sums of unsigned words are kept unlimited, as numbers that equal the machine's but for a multiple of 2^32 or
 * 2^64, so that `(int32_t)((uint32_t)a + (uint32_t)b)` is a + b. Where such a number is made signed, is compared, is
 * shifted right or divides, it has to lie within its word; and so has each signed result. If it does not, that is a
 * complaint, which names the lines, and from there on the word may hold anything. So ranges are always those of the
 * machine's numbers, and without complaints the machine's numbers are those that the text means.
 *
 * What is refused. The firmware collects in one word (`noted |= v`) what is too large, and refuses the result if that
 * word reaches noted_limit. In a run that is not refused each v is below the limit, and that bounds what v was made of.
 * So the program runs again and again (`prove`): what one run learns of a number bounds it in the next, in the place
 * where it is made, until nothing more is learned. The next run knows a number by its key: its place in the order of
 * numbers since the last comparison, and the answers to all comparisons before. A bound of v also bounds what v is made
 * of, but only through steps in which nothing wrapped. One run's ranges hold for whatever is not refused; by induction
 * the next run's do. A number takes its bound only where its range without the bound fits the word.
 *
 * Lengths. Turns keep a vector's length, but the box around a turned vector grows. So a table says of numbers together
 * that the root of the sum of their squares is at most so much; `has_length` enters such a fact, `length_of` asks for
 * one, and answers what the ranges give where there is none. Whoever enters one has to argue why.
 *
 * Sizes together. Of some unknown sizes (a limb's lengths) only the sum is bounded. `with_shares` says of a number that
 * it is at most so much for each of them, and so much more; sums and multiples keep that.
 *
 * Branches. `each_way` runs what branches on numbers once for each way. Elsewhere an open comparison is a complaint.
 *
 * One number each. With `is_exact` set the same program runs on single numbers, that wrap as the machine's do. Then
 * `outside` counts those that lie outside the range that the proof gave their word: a stand-in that promises too much
 * is found by that.
 */
#ifndef BRACE_PROOF_RANGED_H
#define BRACE_PROOF_RANGED_H

#include <execinfo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace ranged {

using wide_t = __int128;

struct range_t {
    wide_t least, most;
};

/* A word's kind: how many bits, and whether it has a sign. */
struct kind_t {
    int bits;
    bool is_signed;
};

inline range_t all_of(kind_t kind)
{
    const wide_t one = 1;
    return kind.is_signed ? range_t{-(one << (kind.bits - 1)), (one << (kind.bits - 1)) - 1}
                          : range_t{0, (one << kind.bits) - 1};
}

inline bool is_within(range_t inner, range_t outer)
{
    return inner.least >= outer.least && inner.most <= outer.most;
}

enum class made_by_t { given, constant, cast, plus, less, times, left, right, magnitude, zeros, other };

/* A number is another one times a factor, and off from that by so much, at most. */
struct multiple_t {
    std::size_t of;
    long double factor, off;
};

/* A number is at most so much for each of some unknown sizes, and so much more. The sizes are at least zero and their
 * sum is at most 1. */
struct shares_t {
    bool is_known = false;
    std::array<long double, 3> by{};
    long double more = 0.0L;

    [[nodiscard]] long double most() const { return *std::max_element(by.begin(), by.end()) + more; }

    [[nodiscard]] shares_t times(long double factor, long double cut = 0.0L) const
    {
        return {is_known, {by[0] * factor, by[1] * factor, by[2] * factor}, more * factor + cut};
    }
};

inline shares_t sum_of(const shares_t &a, const shares_t &b)
{
    return {a.is_known && b.is_known, {a.by[0] + b.by[0], a.by[1] + b.by[1], a.by[2] + b.by[2]}, a.more + b.more};
}

/* A number that the program has made. */
struct number_t {
    made_by_t made_by;
    kind_t kind;
    range_t range;
    std::size_t from, with;  /* what it was made of */
    std::size_t size_as;     /* a number of the same magnitude, and whether of the other sign */
    bool is_minus;
    std::size_t sign_as;     /* a number of the same sign (zero counts as positive), or of the other one */
    bool is_other_sign;
    std::size_t top_as;      /* a number with the same highest bit */
    multiple_t multiple[2];  /* a product is one of either factor */
    shares_t shares;
    int right; /* made_by right: bits; right of 64 unsigned bits that may be negative: whole below that */
    int whole_bits; /* how many of its lower bits are the machine's */
    std::size_t zeros_of; /* it is the leading zeros of that number, plus zeros_more */
    int zeros_more;
};

constexpr std::size_t none = ~std::size_t{0};

using key_t = std::pair<int, std::size_t>; /* the branches taken, the how-manieth number since */

class machine {
public:
    std::vector<number_t> numbers;
    std::vector<key_t> keys;
    std::map<key_t, range_t> known, learned; /* from the runs before; in this one */
    std::map<std::vector<std::size_t>, long double> lengths;
    std::vector<std::pair<std::string, std::string>> complaints; /* place, and the first that was found there */
    std::set<std::string> places;
    std::size_t complaint_count = 0;
    wide_t noted_limit = 0;
    std::size_t first_to_learn_of = 0; /* notes bound no number before this one */
    bool is_exact = false;
    std::vector<std::size_t> broken; /* single numbers that break what is known of them */
    /* Within each_way: */
    bool in_ways = false;
    int way = 0;
    std::map<std::array<std::size_t, 3>, int> ways; /* from a way, after so many numbers, by an answer: the next one */
    std::size_t since = 0, first_of_way = 0;
    std::vector<bool> decided, to_decide;
    std::vector<std::pair<std::size_t, range_t>> refined;

    void begin()
    {
        numbers.clear();
        keys.clear();
        lengths.clear();
        complaints.clear();
        places.clear();
        broken.clear();
        learned.clear();
        way = 0;
        since = 0;
        first_of_way = 0;
        first_to_learn_of = 0;
        for (const kind_t kind : {kind_t{32, true}, {32, false}, {64, true}, {64, false}}) {
            make(made_by_t::constant, kind, {0, 0});
        }
        in_ways = false;
        refined.clear();
    }

    /* The number that an object that nobody has written holds. */
    static std::size_t zero_of(kind_t kind) { return (kind.bits == 64 ? 2u : 0u) + (kind.is_signed ? 0u : 1u); }

    void keep(std::size_t id, bool does)
    {
        if (!does) {
            broken.push_back(id);
        }
    }

    static std::string where()
    {
        std::array<void *, 24> frames{};
        const int count = backtrace(frames.data(), static_cast<int>(frames.size()));
        std::string text;
        for (int i = 0; i < count; i++) {
            std::array<char, 24> buffer{};
            std::snprintf(buffer.data(), buffer.size(), " %p", static_cast<void *>(static_cast<char *>(frames[i]) - 1));
            text += buffer.data();
        }
        return text;
    }

    void complain(const std::string &what)
    {
        if (is_exact) {
            return;
        }
        complaint_count++;
        const std::string place = where();
        if (places.insert(place).second) {
            complaints.emplace_back(place, what);
        }
    }

    static std::string text_of(range_t range)
    {
        std::array<char, 80> buffer{};
        std::snprintf(buffer.data(), buffer.size(), "%.6Lg to %.6Lg", static_cast<long double>(range.least),
                      static_cast<long double>(range.most));
        return buffer.data();
    }

    std::size_t make(made_by_t made_by, kind_t kind, range_t range, std::size_t from = none, std::size_t with = none)
    {
        const wide_t far = wide_t{1} << 120;
        if (kind.is_signed ? !is_within(range, all_of(kind)) : !is_within(range, {-far, far})) {
            complain(std::to_string(kind.bits) + " bits do not hold " + text_of(range));
            range = is_exact ? wrapped(range.least, kind) : all_of(kind);
            made_by = made_by_t::other;
        }
        for (const std::size_t part : {from, with}) {
            if (part != none && made_by != made_by_t::cast && numbers[part].whole_bits < numbers[part].kind.bits) {
                complain("upper bits that are not the number's");
            }
        }
        const key_t key{way, since++};
        if (!is_exact) {
            const auto fact = known.find(key);
            if (fact != known.end()) {
                range = {std::max(range.least, fact->second.least), std::min(range.most, fact->second.most)};
                if (range.least > range.most) {
                    complain("nothing is left: " + text_of(range));
                    range = all_of(kind);
                }
            }
        }
        const std::size_t id = numbers.size();
        const multiple_t itself{id, 1.0L, 0.0L};
        numbers.push_back(
            {made_by, kind, range, from, with, id, false, id, false, id, {itself, itself}, {}, 0, kind.bits, none, 0});
        keys.push_back(key);
        return id;
    }

    static range_t wrapped(wide_t number, kind_t kind)
    {
        const wide_t whole = wide_t{1} << kind.bits;
        wide_t left = number % whole;
        left = left < all_of(kind).least ? left + whole : left > all_of(kind).most ? left - whole : left;
        return {left, left};
    }

    /* The machine's numbers of an unsigned one that was kept unlimited. */
    range_t settled(std::size_t id)
    {
        const number_t &n = numbers[id];
        if (n.whole_bits < n.kind.bits) {
            complain("upper bits that are not the number's");
        }
        if (is_exact) {
            return wrapped(n.range.least, n.kind);
        }
        if (is_within(n.range, all_of(n.kind))) {
            return n.range;
        }
        const wide_t whole = wide_t{1} << n.kind.bits;
        if (is_within({n.range.least + whole, n.range.most + whole}, all_of(n.kind))) {
            return {n.range.least + whole, n.range.most + whole};
        }
        complain(std::to_string(n.kind.bits) + " unsigned bits do not hold " + text_of(n.range));
        return all_of(n.kind);
    }

    std::size_t cast(std::size_t id, kind_t kind)
    {
        const number_t n = numbers[id];
        range_t range = n.range;
        made_by_t by_what = made_by_t::cast;
        if (n.whole_bits < n.kind.bits && n.whole_bits < kind.bits) {
            complain("upper bits that are not the number's");
            range = is_exact ? range : all_of(kind);
            by_what = made_by_t::other;
        }
        if (!n.kind.is_signed && kind.bits > n.kind.bits) { /* the upper bits are zero */
            range = settled(id);
            by_what = range.least == n.range.least ? by_what : made_by_t::other;
        }
        const std::size_t made = make(by_what, kind, range, id);
        keep_origin(made, id);
        return made;
    }

    /* That `made` has the magnitude of `id`, if it is the same number. */
    void keep_origin(std::size_t made, std::size_t id, bool is_minus = false)
    {
        if (numbers[made].made_by == made_by_t::other) {
            return;
        }
        numbers[made].size_as = numbers[id].size_as;
        numbers[made].is_minus = numbers[id].is_minus != is_minus;
        numbers[made].sign_as = numbers[id].sign_as;
        numbers[made].is_other_sign = numbers[id].is_other_sign != is_minus;
        keep_multiples(made, id, 1.0L, 0.0L);
        if (!is_minus) {
            numbers[made].top_as = numbers[id].top_as;
            numbers[made].zeros_of = numbers[id].zeros_of;
            numbers[made].zeros_more = numbers[id].zeros_more;
        }
    }

    /* That `made` is `id` times a factor, and what is cut off. */
    void keep_multiples(std::size_t made, std::size_t id, long double factor, long double cut)
    {
        for (int i = 0; i < 2 && numbers[made].made_by != made_by_t::other; i++) {
            const multiple_t &m = numbers[id].multiple[i];
            numbers[made].multiple[i] = {m.of, m.factor * factor, m.off * factor + cut};
        }
        if (numbers[made].made_by != made_by_t::other) {
            numbers[made].shares = has_shares(id) ? numbers[id].shares.times(factor, cut) : shares_t{};
        }
    }

    /* What is known of a number by shares; of one without any, its size. */
    shares_t shares_of(std::size_t id) const
    {
        const range_t range = numbers[id].range;
        const long double size = static_cast<long double>(std::max(range.most, -range.least));
        return has_shares(id) ? numbers[id].shares : shares_t{true, {}, size};
    }

    /* Shares that come to much more than the number's size are no help. */
    bool has_shares(std::size_t id) const
    {
        const range_t range = numbers[id].range;
        const long double size = static_cast<long double>(std::max(range.most, -range.least));
        return numbers[id].shares.is_known && numbers[id].shares.most() <= 1.1L * size;
    }

    shares_t shares_of_sum(std::size_t a, std::size_t b) const
    {
        const bool is_known = has_shares(a) || has_shares(b);
        return is_known ? sum_of(shares_of(a), shares_of(b)) : shares_t{};
    }

    /* A sum of multiples of two parts of a vector: Cauchy's inequality. */
    long double sum_most(std::size_t a, std::size_t b) const
    {
        long double most = 0x1p120L;
        for (const multiple_t &m : numbers[a].multiple) {
            for (const multiple_t &n : numbers[b].multiple) {
                const auto fact = lengths.find({std::min(m.of, n.of), std::max(m.of, n.of)});
                if (fact != lengths.end()) {
                    const long double factors = std::sqrt(m.factor * m.factor + n.factor * n.factor);
                    most = std::min(most, (fact->second * factors + m.off + n.off) * (1.0L + 0x1p-50L) + 1.0L);
                }
            }
        }
        return most;
    }

    range_t sum_range(std::size_t a, std::size_t b, range_t range) const
    {
        const shares_t shares = shares_of_sum(a, b);
        const long double by_shares = shares.is_known ? shares.most() * (1.0L + 0x1p-50L) + 1.0L : 0x1p120L;
        const long double most = is_exact ? 0x1p120L : std::min(sum_most(a, b), by_shares);
        const wide_t whole = static_cast<wide_t>(std::min(most, 0x1p119L));
        return most >= 0x1p119L ? range : range_t{std::max(range.least, -whole), std::min(range.most, whole)};
    }

    /* What a run that is not refused shows of a number, and so of those it was made of. */
    void learn(std::size_t id, range_t range, int steps = 12)
    {
        if (is_exact || id == none || steps == 0 || id < first_of_way || id < first_to_learn_of) {
            return;
        }
        const number_t &n = numbers[id];
        if (n.made_by == made_by_t::constant) {
            return;
        }
        const range_t both = {std::max(n.range.least, range.least), std::min(n.range.most, range.most)};
        if (!is_within(n.range, range)) {
            auto [place, is_new] = learned.emplace(keys[id], both);
            if (!is_new) {
                place->second = {std::max(place->second.least, both.least), std::min(place->second.most, both.most)};
            }
        }
        const range_t from = n.from == none ? both : numbers[n.from].range;
        const range_t with = n.with == none ? both : numbers[n.with].range;
        switch (n.made_by) {
        case made_by_t::cast: /* what was not wrapped: else it was made by `other` */
            learn(n.from, both, steps - 1);
            break;
        case made_by_t::right:
            learn(n.from, {both.least << n.right, ((both.most + 1) << n.right) - 1}, steps - 1);
            break;
        case made_by_t::magnitude: learn(n.from, {-both.most - 1, both.most}, steps - 1); break;
        case made_by_t::plus:
            learn(n.from, {both.least - with.most, both.most - with.least}, steps - 1);
            learn(n.with, {both.least - from.most, both.most - from.least}, steps - 1);
            break;
        case made_by_t::less:
            learn(n.from, {both.least + with.least, both.most + with.most}, steps - 1);
            learn(n.with, {from.least - both.most, from.most - both.least}, steps - 1);
            break;
        default: break;
        }
    }

    /* On from here by a branch. */
    void take(int answer)
    {
        const std::array<std::size_t, 3> step{static_cast<std::size_t>(way), since, static_cast<std::size_t>(answer)};
        way = ways.emplace(step, static_cast<int>(ways.size()) + 1).first->second;
        since = 0;
    }

    /* What a branch that was taken shows of a number, on this way. */
    void refine(std::size_t id, range_t range)
    {
        range_t &old = numbers[id].range;
        refined.emplace_back(id, old);
        old = {std::max(old.least, range.least), std::min(old.most, range.most)};
    }

    /* A comparison that ranges leave open: one way after the other within each_way. */
    bool decide(bool is_sure, bool answer)
    {
        if (!is_sure && !in_ways) {
            complain("a comparison that is open");
            first_of_way = numbers.size(); /* numbers from here on belong to one of two ways only */
        } else if (!is_sure) {
            const std::size_t at = decided.size();
            answer = at < to_decide.size() ? to_decide[at] : false;
            decided.push_back(answer);
        }
        take(answer ? 1 : 0);
        return answer;
    }
};

inline machine now;

inline long double size_in(range_t range)
{
    return static_cast<long double>(std::max(range.most, -range.least));
}

/* --- words ---------------------------------------------------------------------------------------------------- */

template <int BITS, bool IS_SIGNED> class word {
public:
    static constexpr kind_t kind{BITS, IS_SIGNED};
    std::size_t id;

    word() : id(machine::zero_of(kind)) {} /* static objects outlive a run, so this number is the same in all */
    template <class NUMBER>
        requires(std::integral<NUMBER> || std::is_enum_v<NUMBER>)
    word(NUMBER number) : id(constant(static_cast<wide_t>(number)))
    {
    }
    template <std::floating_point NUMBER> explicit word(NUMBER number) : id(constant(static_cast<wide_t>(number))) {}
    template <int OTHER_BITS, bool OTHER_SIGNED>
        requires(OTHER_BITS != BITS || OTHER_SIGNED != IS_SIGNED)
    word(const word<OTHER_BITS, OTHER_SIGNED> &other) : id(now.cast(other.id, kind))
    {
    }

    static word of(std::size_t id)
    {
        word made{already_t{}};
        made.id = id;
        return made;
    }

    [[nodiscard]] range_t range() const { return now.numbers[id].range; }

private:
    struct already_t {};
    explicit word(already_t) : id(none) {}

    static std::size_t constant(wide_t number) { return now.make(made_by_t::constant, kind, {number, number}); }
};

using i32 = word<32, true>;
using u32 = word<32, false>;
using i64 = word<64, true>;
using u64 = word<64, false>;

template <class T> struct is_word : std::false_type {};
template <int BITS, bool IS_SIGNED> struct is_word<word<BITS, IS_SIGNED>> : std::true_type {};
template <class T>
concept a_word = is_word<T>::value;

/* The word that C makes of a number in a sum. */
template <class T> struct promoted {
    using type = std::conditional_t<(sizeof(T) > 4), std::conditional_t<std::is_signed_v<T>, i64, u64>,
                                    std::conditional_t<std::is_signed_v<T> || sizeof(T) < 4, i32, u32>>;
};
template <int BITS, bool IS_SIGNED> struct promoted<word<BITS, IS_SIGNED>> {
    using type = word<BITS, IS_SIGNED>;
};
template <class T> using promoted_t = typename promoted<T>::type;

/* And the word of a sum of two. */
template <class A, class B>
using common_t = std::conditional_t<A::kind.bits == B::kind.bits, std::conditional_t<A::kind.is_signed, B, A>,
                                    std::conditional_t<(A::kind.bits > B::kind.bits), A, B>>;

template <class A, class B>
concept some_word = (a_word<A> && (a_word<B> || std::integral<B>)) || (std::integral<A> && a_word<B>);
template <class A, class B> using sum_t = common_t<promoted_t<A>, promoted_t<B>>;

/* A word with a range that the harness gives. */
template <a_word W> W any(wide_t least, wide_t most)
{
    return W::of(now.make(made_by_t::given, W::kind, {least, most}));
}

template <class A, class B>
    requires some_word<A, B>
auto operator+(const A &a, const B &b)
{
    using W = sum_t<A, B>;
    const W x(a), y(b);
    const range_t p = x.range(), q = y.range();
    const range_t range = now.sum_range(x.id, y.id, {p.least + q.least, p.most + q.most});
    const std::size_t made = now.make(made_by_t::plus, W::kind, range, x.id, y.id);
    if (now.numbers[made].made_by == made_by_t::plus) {
        now.numbers[made].shares = now.shares_of_sum(x.id, y.id);
    }
    if (q.least == 0 && q.most == 0) {
        now.keep_origin(made, x.id);
    } else if (q.least == q.most && now.numbers[x.id].zeros_of != none) {
        now.numbers[made].zeros_of = now.numbers[x.id].zeros_of;
        now.numbers[made].zeros_more = now.numbers[x.id].zeros_more + static_cast<int>(q.least);
    }
    return W::of(made);
}

template <class A, class B>
    requires some_word<A, B>
auto operator-(const A &a, const B &b)
{
    using W = sum_t<A, B>;
    const W x(a), y(b);
    const range_t p = x.range(), q = y.range();
    const range_t range = now.sum_range(x.id, y.id, {p.least - q.most, p.most - q.least});
    const std::size_t made = now.make(made_by_t::less, W::kind, range, x.id, y.id);
    if (now.numbers[made].made_by == made_by_t::less) {
        now.numbers[made].shares = now.shares_of_sum(x.id, y.id);
    }
    if (p.least == 0 && p.most == 0) {
        now.keep_origin(made, y.id, true);
    } else if (q.least == q.most && now.numbers[x.id].zeros_of != none) {
        now.numbers[made].zeros_of = now.numbers[x.id].zeros_of;
        now.numbers[made].zeros_more = now.numbers[x.id].zeros_more - static_cast<int>(q.least);
    }
    return W::of(made);
}

template <a_word A> A operator-(const A &a)
{
    return A(0) - a;
}

template <class A, class B>
    requires some_word<A, B>
auto operator*(const A &a, const B &b)
{
    using W = sum_t<A, B>;
    const W x(a), y(b);
    const range_t p = x.range(), q = y.range();
    const wide_t corner[] = {p.least * q.least, p.least * q.most, p.most * q.least, p.most * q.most};
    range_t range = {*std::min_element(corner, corner + 4), *std::max_element(corner, corner + 4)};
    const number_t m = now.numbers[x.id], n = now.numbers[y.id];
    if (m.sign_as == n.sign_as && m.is_other_sign == n.is_other_sign) { /* a square, or about one */
        range.least = std::max(range.least, wide_t{0});
    } else if (!now.is_exact) { /* of two parts of a vector: half its length's square at most */
        const auto fact = now.lengths.find({std::min(m.size_as, n.size_as), std::max(m.size_as, n.size_as)});
        if (fact != now.lengths.end() && fact->second < 0x1p50L) {
            const wide_t most = static_cast<wide_t>(fact->second * fact->second / 2.0L) + 1;
            range = {std::max(range.least, -most), std::min(range.most, most)};
        }
    }
    const std::size_t made = now.make(made_by_t::times, W::kind, range, x.id, y.id);
    const std::size_t of_x = m.size_as, of_y = n.size_as;
    if (now.numbers[made].made_by == made_by_t::times) {
        now.numbers[made].multiple[0] = {of_x, size_in(q), 0.0L};
        now.numbers[made].multiple[1] = {of_y, size_in(p), 0.0L};
        now.numbers[made].shares = now.has_shares(x.id)   ? m.shares.times(size_in(q))
                                   : now.has_shares(y.id) ? n.shares.times(size_in(p))
                                                          : shares_t{};
    }
    return W::of(made);
}

inline wide_t floored(wide_t number, int bits)
{
    return number >> bits; /* of a signed number, rounded down */
}

/* Shifts' bits: a word or a number. */
template <class B> range_t bits_of_shift(const B &by, int limit)
{
    range_t range;
    if constexpr (a_word<B>) {
        range = by.range();
    } else {
        range = {static_cast<wide_t>(by), static_cast<wide_t>(by)};
    }
    if (range.least < 0 || range.most >= limit) {
        now.complain("a shift out of range: " + machine::text_of(range));
        range = {0, limit - 1};
    }
    return range;
}

template <a_word A, class B>
    requires(a_word<B> || std::integral<B>)
A operator>>(const A &a, const B &by)
{
    const range_t bits = bits_of_shift(by, A::kind.bits);
    const number_t n = now.numbers[a.id];
    range_t p = n.range;
    int whole = A::kind.bits;
    bool is_same = true;
    if (!A::kind.is_signed) {
        /* 64 bits, known but for a multiple of 2^64, that are signed: what is shifted in is not the number's. */
        const bool is_below =
            A::kind.bits == 64 && p.least < 0 && is_within(p, all_of(i64::kind)) && bits.least == bits.most;
        whole = is_below ? A::kind.bits - static_cast<int>(bits.least) : whole;
        p = is_below ? p : now.settled(a.id);
        is_same = p.least == n.range.least;
    }
    const int few = static_cast<int>(bits.least), many = static_cast<int>(bits.most);
    const range_t range = {std::min(floored(p.least, few), floored(p.least, many)),
                           std::max(floored(p.most, few), floored(p.most, many))};
    const bool is_one_way = few == many && is_same;
    const std::size_t made = now.make(is_one_way ? made_by_t::right : made_by_t::other, A::kind, range, a.id);
    now.numbers[made].right = few;
    if (few == many && is_same) {
        now.keep_multiples(made, a.id, 1.0L / static_cast<long double>(wide_t{1} << few), 1.0L);
    }
    if (is_same && A::kind.is_signed && !n.is_other_sign) {
        now.numbers[made].sign_as = n.sign_as;
    }
    now.numbers[made].whole_bits = whole;
    return A::of(made);
}

template <a_word A, class B>
    requires(a_word<B> || std::integral<B>)
A operator<<(const A &a, const B &by)
{
    const range_t bits = bits_of_shift(by, A::kind.bits);
    const range_t p = a.range();
    if (A::kind.is_signed && p.least < 0) {
        now.complain("a negative number shifted up: " + machine::text_of(p));
    }
    const wide_t few = wide_t{1} << static_cast<int>(bits.least), many = wide_t{1} << static_cast<int>(bits.most);
    range_t range = {std::min(p.least * few, p.least * many), std::max(p.most * few, p.most * many)};
    if constexpr (a_word<B>) { /* by its own leading zeros */
        const number_t &n = now.numbers[by.id];
        if (A::kind.bits == 32 && n.zeros_of != none && !now.is_exact && p.least > 0 && n.zeros_more <= 0 &&
            now.numbers[n.zeros_of].top_as == now.numbers[a.id].top_as) {
            const int top = A::kind.bits + n.zeros_more;
            range = {std::max(range.least, wide_t{1} << (top - 1)), std::min(range.most, (wide_t{1} << top) - 1)};
        }
    }
    const std::size_t made = now.make(made_by_t::left, A::kind, range, a.id);
    if (bits.least == bits.most) {
        now.keep_multiples(made, a.id, static_cast<long double>(few), 0.0L);
    }
    return A::of(made);
}

template <std::integral A, a_word B> auto operator>>(A a, const B &by)
{
    return promoted_t<A>(a) >> by;
}

template <class A, class B>
    requires some_word<A, B>
auto operator/(const A &a, const B &b)
{
    using W = sum_t<A, B>;
    const W x(a), y(b);
    const range_t p = W::kind.is_signed ? x.range() : now.settled(x.id);
    const range_t q = W::kind.is_signed ? y.range() : now.settled(y.id);
    if (q.least <= 0) {
        now.complain("a divisor that may not be positive: " + machine::text_of(q));
        return W::of(now.make(made_by_t::other, W::kind, all_of(W::kind)));
    }
    const wide_t corner[] = {p.least / q.least, p.least / q.most, p.most / q.least, p.most / q.most};
    return W::of(now.make(made_by_t::other, W::kind,
                          {*std::min_element(corner, corner + 4), *std::max_element(corner, corner + 4)}, x.id, y.id));
}

inline wide_t filled(wide_t number)
{
    wide_t ones = 0;
    while (ones < number) {
        ones = 2 * ones + 1;
    }
    return ones;
}

template <class A, class B>
    requires some_word<A, B>
auto operator&(const A &a, const B &b)
{
    using W = sum_t<A, B>;
    const W x(a), y(b);
    const range_t p = W::kind.is_signed ? x.range() : now.settled(x.id);
    const range_t q = W::kind.is_signed ? y.range() : now.settled(y.id);
    range_t range = p.least >= 0 && q.least >= 0 ? range_t{0, std::min(p.most, q.most)}
                    : p.least >= 0               ? range_t{0, p.most}
                    : q.least >= 0               ? range_t{0, q.most}
                                                 : all_of(W::kind);
    if (now.is_exact) {
        range = {p.least & q.least, p.least & q.least};
    }
    return W::of(now.make(made_by_t::other, W::kind, range, x.id, y.id));
}

template <class A, class B>
    requires some_word<A, B>
auto operator|(const A &a, const B &b)
{
    using W = sum_t<A, B>;
    const W x(a), y(b);
    const range_t p = W::kind.is_signed ? x.range() : now.settled(x.id);
    const range_t q = W::kind.is_signed ? y.range() : now.settled(y.id);
    range_t range = all_of(W::kind);
    if (p.least >= 0 && q.least >= 0) {
        range = {std::max(p.least, q.least), std::min(filled(p.most) | filled(q.most), p.most + q.most)};
    }
    if (now.is_exact) {
        range = {p.least | q.least, p.least | q.least};
    }
    const std::size_t made = now.make(made_by_t::other, W::kind, range, x.id, y.id);
    if (q.least == 1 && q.most == 1 && p.least > 0) { /* `| 1u` leaves leading zeros as they are */
        now.numbers[made].top_as = now.numbers[x.id].top_as;
    }
    return W::of(made);
}

/* With a sign, 0 or all ones: a magnitude, or one unit less than the negative number. */
template <class A, class B>
    requires some_word<A, B>
auto operator^(const A &a, const B &b)
{
    using W = sum_t<A, B>;
    const W x(a), y(b);
    const range_t p = x.range(), q = y.range();
    const number_t n = now.numbers[y.id];
    if (now.is_exact) {
        return W::of(now.make(made_by_t::other, W::kind, {p.least ^ q.least, p.least ^ q.least}));
    }
    if (!W::kind.is_signed || !is_within(q, {-1, 0})) {
        now.complain("bits of both: not known");
        return W::of(now.make(made_by_t::other, W::kind, all_of(W::kind)));
    }
    if (n.made_by == made_by_t::right && n.from == x.id && n.right == W::kind.bits - 1) {
        const wide_t least = p.least > 0 ? p.least : p.most < 0 ? -p.most - 1 : 0;
        const wide_t most = std::max(p.most, -p.least - 1);
        return W::of(now.make(made_by_t::magnitude, W::kind, {least, most}, x.id));
    }
    return W::of(now.make(made_by_t::other, W::kind, {std::min(p.least, -p.most - 1), std::max(p.most, -p.least - 1)}));
}

template <a_word A> A operator~(const A &a)
{
    const range_t p = a.range();
    return A::of(now.make(made_by_t::other, A::kind, {-p.most - 1, -p.least - 1}));
}

template <a_word A, class B> A &operator+=(A &a, const B &b)
{
    return a = a + b;
}
template <a_word A, class B> A &operator-=(A &a, const B &b)
{
    return a = a - b;
}
template <a_word A, class B> A &operator*=(A &a, const B &b)
{
    return a = a * b;
}
template <a_word A, class B> A &operator>>=(A &a, const B &b)
{
    return a = a >> b;
}
template <a_word A, class B> A &operator<<=(A &a, const B &b)
{
    return a = a << b;
}
template <a_word A, class B> A &operator&=(A &a, const B &b)
{
    return a = a & b;
}

/* What is noted: below the limit in a run that is not refused. */
template <a_word A, class B> A &operator|=(A &a, const B &b)
{
    const A v(b);
    if (now.is_exact) {
        const wide_t whole = now.settled(a.id).least | now.settled(v.id).least;
        return a = A::of(now.make(made_by_t::other, A::kind, {whole, whole}));
    }
    const range_t range = v.range(), limit = {0, now.noted_limit - 1}, size = all_of(A::kind);
    /* no other number of the range is below the limit but for a multiple of the word's */
    if (range.least > limit.most - size.most - 1 && range.most <= size.most) {
        now.learn(v.id, limit);
    }
    return a = A::of(now.make(made_by_t::other, A::kind, limit));
}

/* a < b, and what that shows of both where ranges leave it open. */
template <class A, class B> bool is_less(const A &a, const B &b)
{
    using W = sum_t<A, B>;
    const W x(a), y(b);
    const range_t p = W::kind.is_signed ? x.range() : now.settled(x.id);
    const range_t q = W::kind.is_signed ? y.range() : now.settled(y.id);
    const bool is_open = p.most >= q.least && p.least < q.most;
    const bool answer = now.decide(!is_open, p.most < q.least);
    if (is_open && now.in_ways && p.least == x.range().least && q.least == y.range().least) {
        now.refine(x.id, answer ? range_t{p.least, q.most - 1} : range_t{q.least, p.most});
        now.refine(y.id, answer ? range_t{p.least + 1, q.most} : range_t{q.least, p.most});
    }
    return answer;
}

template <class A, class B>
    requires some_word<A, B>
bool operator<(const A &a, const B &b)
{
    return is_less(a, b);
}
template <class A, class B>
    requires some_word<A, B>
bool operator>(const A &a, const B &b)
{
    return is_less(b, a);
}
template <class A, class B>
    requires some_word<A, B>
bool operator<=(const A &a, const B &b)
{
    return !is_less(b, a);
}
template <class A, class B>
    requires some_word<A, B>
bool operator>=(const A &a, const B &b)
{
    return !is_less(a, b);
}
template <class A, class B>
    requires some_word<A, B>
bool operator==(const A &a, const B &b)
{
    using W = sum_t<A, B>;
    const W x(a), y(b);
    const range_t p = W::kind.is_signed ? x.range() : now.settled(x.id);
    const range_t q = W::kind.is_signed ? y.range() : now.settled(y.id);
    const bool is_apart = p.most < q.least || p.least > q.most;
    const bool is_one = p.least == p.most && q.least == q.most && p.least == q.least;
    return now.decide(is_apart || is_one, is_one);
}
template <class A, class B>
    requires some_word<A, B>
bool operator!=(const A &a, const B &b)
{
    return !(a == b);
}

/* Stands for __builtin_clz. */
template <a_word A> i32 leading_zeros_of(const A &number)
{
    const u32 word(number);
    const range_t range = now.settled(word.id);
    if (range.least <= 0) {
        now.complain("leading zeros of what may be zero: " + machine::text_of(range));
        return i32::of(now.make(made_by_t::other, i32::kind, all_of(i32::kind)));
    }
    const int least = __builtin_clz(static_cast<unsigned>(range.most));
    const int most = __builtin_clz(static_cast<unsigned>(range.least));
    const std::size_t made = now.make(made_by_t::zeros, i32::kind, {least, most}, word.id);
    now.numbers[made].zeros_of = word.id;
    return i32::of(made);
}

/* --- facts that the harness enters ---------------------------------------------------------------------------- */

/* What is known of a number from elsewhere: as an assumption, or as the promise of another proof. A single number has
 * to keep it. */
template <a_word W> W within(const W &w, wide_t least, wide_t most)
{
    range_t &range = now.numbers[w.id].range;
    if (now.is_exact) {
        now.keep(w.id, range.least >= least && range.most <= most);
    } else {
        range = {std::max(range.least, least), std::min(range.most, most)};
    }
    return w;
}

template <a_word W> long double size_of(const W &w)
{
    return size_in(w.range());
}

inline std::vector<std::size_t> lengths_key(const std::vector<i32> &parts)
{
    std::vector<std::size_t> key;
    for (const i32 &part : parts) {
        key.push_back(now.numbers[part.id].size_as);
    }
    std::sort(key.begin(), key.end());
    return key;
}

inline long double length_of_ranges(const std::vector<i32> &parts)
{
    long double square = 0.0L;
    for (const i32 &part : parts) {
        square += size_of(part) * size_of(part);
    }
    return std::sqrt(square) * (1.0L + 0x1p-50L);
}

/* The root of the sum of the parts' squares, at most. */
inline long double length_of(const std::vector<i32> &parts)
{
    long double most = length_of_ranges(parts);
    for (std::size_t i = 0; i < parts.size() && parts.size() == 3; i++) { /* two of three, and the third */
        const long double two = length_of({parts[(i + 1) % 3], parts[(i + 2) % 3]}), one = size_of(parts[i]);
        most = std::min(most, std::sqrt(two * two + one * one) * (1.0L + 0x1p-50L));
    }
    const auto fact = now.lengths.find(lengths_key(parts));
    return fact == now.lengths.end() ? most : std::min(most, fact->second);
}

/* Enters that fact, and so bounds each part. */
inline void has_length(const std::vector<i32> &parts, long double most)
{
    if (now.is_exact) {
        for (const i32 &part : parts) {
            now.keep(part.id, length_of_ranges(parts) <= most + 1.0L);
        }
        return;
    }
    auto [fact, is_new] = now.lengths.emplace(lengths_key(parts), most);
    fact->second = is_new ? most : std::min(fact->second, most);
    const wide_t whole = static_cast<wide_t>(std::ceil(std::min(most, 0x1p100L)));
    for (const i32 &part : parts) {
        within(part, -whole, whole);
    }
    if (parts.size() == 3) {
        has_length({parts[0], parts[1]}, most);
        has_length({parts[1], parts[2]}, most);
        has_length({parts[2], parts[0]}, most);
    }
}

/* Enters what is known of a number by shares, and so bounds it. */
template <a_word W> W with_shares(const W &w, const shares_t &shares)
{
    if (shares.is_known) {
        now.numbers[w.id].shares = shares;
        const wide_t whole = static_cast<wide_t>(std::ceil(std::min(shares.most(), 0x1p100L)));
        within(w, -whole, whole);
    }
    return w;
}

/* --- branches ------------------------------------------------------------------------------------------------- */

/* Runs what branches on numbers once for each way that it may take. returns what it returned, of all ways. On a way
 * nothing is learned of numbers made before; and of a number that several ways make, only what all of them learn. */
template <class RUN> auto each_way(RUN run)
{
    std::vector<decltype(run())> results;
    const int way_before = now.way;
    const std::size_t since_before = now.since, first_before = now.first_of_way;
    const bool was_in_ways = now.in_ways;
    const std::vector<bool> decided_before = now.decided, to_decide_before = now.to_decide;
    const std::map<key_t, range_t> learned_before = now.learned;
    std::map<key_t, int> ways_of;
    std::map<key_t, std::pair<int, range_t>> learned_on_ways;
    now.to_decide.clear();
    while (true) {
        now.in_ways = true;
        now.way = way_before;
        now.since = since_before;
        now.take(2);
        now.first_of_way = now.numbers.size();
        now.decided.clear();
        now.learned.clear();
        const std::size_t undone = now.refined.size();
        results.push_back(run());
        for (std::size_t id = now.first_of_way; id < now.numbers.size(); id++) {
            ways_of[now.keys[id]]++;
        }
        for (const auto &[key, range] : now.learned) {
            auto [place, is_new] = learned_on_ways.emplace(key, std::pair{1, range});
            if (!is_new) {
                range_t &all = place->second.second;
                all = {std::min(all.least, range.least), std::max(all.most, range.most)};
                place->second.first++;
            }
        }
        while (now.refined.size() > undone) {
            now.numbers[now.refined.back().first].range = now.refined.back().second;
            now.refined.pop_back();
        }
        now.to_decide = now.decided;
        while (!now.to_decide.empty() && now.to_decide.back()) {
            now.to_decide.pop_back();
        }
        if (now.to_decide.empty()) {
            break;
        }
        now.to_decide.back() = true;
    }
    now.learned = learned_before;
    for (const auto &[key, fact] : learned_on_ways) {
        if (fact.first == ways_of[key]) {
            now.learned.emplace(key, fact.second);
        }
    }
    now.in_ways = was_in_ways;
    now.way = way_before;
    now.since = since_before + 1;
    now.first_of_way = first_before;
    now.decided = decided_before;
    now.to_decide = to_decide_before;
    return results;
}

/* A number that may be any of these. */
template <a_word W> W any_of(const std::vector<W> &words)
{
    range_t range = words.front().range();
    for (const W &w : words) {
        range = {std::min(range.least, w.range().least), std::max(range.most, w.range().most)};
    }
    return W::of(now.make(made_by_t::other, W::kind, range));
}

/* --- the proof ------------------------------------------------------------------------------------------------ */

/* The lines of a complaint, by what the linker knows. */
inline void print_complaint(const std::string &program, const std::string &frames, const std::string &what)
{
    std::printf("%s\n", what.c_str());
    std::fflush(stdout);
    const std::string command = "addr2line -e " + program + " -Cfsp" + frames +
                                " | grep -v -e '^??' -e ranged.h | sed 's/(.*) at / /' | head -8";
    if (std::system(command.c_str()) != 0) {
        std::printf("  at%s\n", frames.c_str());
    }
}

/* Runs the program until nothing more is learned. returns the number of complaints that are left */
template <class RUN> std::size_t prove(RUN run, int runs_most = 400)
{
    now.known.clear();
    now.is_exact = false;
    for (int i = 0; i < runs_most; i++) {
        now.begin();
        run();
        bool is_new = false;
        for (const auto &[key, range] : now.learned) {
            auto [place, is_first] = now.known.emplace(key, range);
            const range_t both = {std::max(place->second.least, range.least), std::min(place->second.most, range.most)};
            is_new = is_new || is_first || both.least != place->second.least || both.most != place->second.most;
            place->second = both;
        }
        if (!is_new) {
            break;
        }
    }
    return now.complaints.size();
}

/* The ranges of the last run, by key. */
inline std::map<key_t, range_t> ranges()
{
    std::map<key_t, range_t> all;
    for (std::size_t id = 0; id < now.numbers.size(); id++) {
        const auto [place, is_new] = all.emplace(now.keys[id], now.numbers[id].range);
        if (!is_new) {
            place->second = {std::min(place->second.least, now.numbers[id].range.least),
                             std::max(place->second.most, now.numbers[id].range.most)};
        }
    }
    return all;
}

/* Runs the program on single numbers. */
template <class RUN> void run_exactly(RUN run)
{
    now.is_exact = true;
    now.begin();
    run();
    now.is_exact = false;
}

/* Then, of the numbers from `first` to before `end`: how many are outside the proven ranges or break what is known. */
inline std::size_t outside(const std::map<key_t, range_t> &proven, std::size_t first, std::size_t end)
{
    std::size_t count = 0;
    for (std::size_t id = first; id < end; id++) {
        const auto place = proven.find(now.keys[id]);
        if (place == proven.end() || !is_within(now.numbers[id].range, place->second)) {
            count++;
        }
    }
    for (const std::size_t id : now.broken) {
        count += id >= first && id < end ? 1 : 0;
    }
    return count;
}

} // namespace ranged

#endif
