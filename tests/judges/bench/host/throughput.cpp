// Postures per second on one core of this host, batch after batch, each version in turn, round by round.
// Prints for each version: "version NAME", its six numbers at the bench's postures as "run ...", "rate POSTURES/S".
// Rates are the best round's at the batch size that suits the version best, by the thread's own processor time:
// other work on the machine lengthens the rest.
#include "bench_data.h"
#include "peer_eigen.hpp"

extern "C" {
#include "brace/planar.h"
#include "brace/planar_batch.h"
}
#include "plain_limb.h"

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

namespace {

constexpr std::size_t largest_batch = 8192;
constexpr std::size_t batch_sizes[] = {1024, largest_batch};
constexpr int rounds = 150;
constexpr double round_s = 2e-3;

const float bench_postures[BENCH_POSTURE_COUNT][3] = BENCH_POSTURES;

struct Inputs {
    std::vector<float> theta1_rad, theta2_rad;
};

using Six = std::array<float, 6>;

struct Version {
    std::string name;
    std::function<void(const Inputs &, std::size_t)> run; // one batch of that size
    std::function<Six(std::size_t)> result;              // at an index of the last batch
    double best_postures_per_s = 0.0;
};

double thread_time_s()
{
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The bench's postures first, then more from the same ranges (a fixed sequence).
Inputs inputs()
{
    Inputs in;
    std::uint32_t state = 20170u;
    const auto uniform = [&state](float low, float high) {
        state = state * 1664525u + 1013904223u;
        return low + (high - low) * static_cast<float>(state >> 8) / 16777216.0f;
    };
    for (std::size_t i = 0; i < largest_batch; i++) {
        const bool given = i < BENCH_POSTURE_COUNT;
        in.theta1_rad.push_back(given ? bench_postures[i][1] : uniform(-1.0f, 1.5f));
        in.theta2_rad.push_back(given ? bench_postures[i][2] : uniform(0.2f, 2.9f));
    }
    return in;
}

Six six(const plain_stiffness_t &k)
{
    return {k.k_xx, k.k_xz, k.k_zz, k.lambda_min, k.lambda_max, k.stiff_axis};
}

Six six(const brace_stiffness_t &k)
{
    return {k.k_xx_n_per_mm,       k.k_xz_n_per_mm,       k.k_zz_n_per_mm,
            k.lambda_min_n_per_mm, k.lambda_max_n_per_mm, k.stiff_axis_rad};
}

// A batch's six columns.
struct Columns {
    std::array<std::vector<float>, 6> column;
    brace_stiffness_soa_t soa;

    Columns()
    {
        column.fill(std::vector<float>(largest_batch));
        soa = {column[0].data(), column[1].data(), column[2].data(),
               column[3].data(), column[4].data(), column[5].data()};
    }
    Columns(const Columns &) = delete;
    Columns &operator=(const Columns &) = delete;

    Six at(std::size_t i) const
    {
        return {column[0][i], column[1][i], column[2][i], column[3][i], column[4][i], column[5][i]};
    }
};

void require(bool ok, const char *what)
{
    if (!ok) {
        std::fprintf(stderr, "throughput: %s failed\n", what);
        std::exit(1);
    }
}

void measure_round(Version &version, const Inputs &in, std::size_t batch_size)
{
    std::size_t batches = 0;
    const double start = thread_time_s();
    double elapsed = 0.0;
    while (elapsed < round_s) {
        version.run(in, batch_size);
        batches++;
        elapsed = thread_time_s() - start;
    }
    const double rate = static_cast<double>(batches * batch_size) / elapsed;
    if (rate > version.best_postures_per_s) {
        version.best_postures_per_s = rate;
    }
}

void print(const Version &version)
{
    std::printf("version %s\n", version.name.c_str());
    for (std::size_t i = 0; i < BENCH_POSTURE_COUNT; i++) {
        std::printf("run");
        for (const float number : version.result(i)) {
            std::uint32_t bits;
            std::memcpy(&bits, &number, sizeof bits);
            std::printf(" %08lx", static_cast<unsigned long>(bits));
        }
        std::printf("\n");
    }
    std::printf("rate %.0f\n", version.best_postures_per_s);
}

} // namespace

int main()
{
    static const brace_limb_t limb = BENCH_PAPER_LIMB, tilted = BENCH_TILTED_LIMB;
    const Inputs in = inputs();
    plain_limb_t plain_limb;
    plain_limb_from_bench(&plain_limb);

    std::vector<plain_stiffness_t> by_eigen(largest_batch), by_plain(largest_batch);
    std::vector<brace_stiffness_t> by_tick(largest_batch);
    Columns columns, tilted_columns;

    brace_planar_t tick;
    brace_planar_t batch, tilted_batch;
    require(brace_planar_collapse(&limb, &tick) == BRACE_OK, "brace_planar_collapse");
    require(brace_planar_collapse(&limb, &batch) == BRACE_OK, "brace_planar_collapse");
    require(brace_planar_collapse(&tilted, &tilted_batch) == BRACE_OK, "brace_planar_collapse, tilted");

    std::vector<Version> versions;
    versions.push_back({"Eigen fixed size, -O3 -march=native",
                        [&](const Inputs &x, std::size_t n) {
                            for (std::size_t i = 0; i < n; i++) {
                                eigen_stiffness(plain_limb, x.theta1_rad[i], x.theta2_rad[i], by_eigen[i]);
                            }
                        },
                        [&](std::size_t i) { return six(by_eigen[i]); }});
    versions.push_back({"plain C, -O3 -march=native",
                        [&](const Inputs &x, std::size_t n) {
                            for (std::size_t i = 0; i < n; i++) {
                                plain_stiffness(&plain_limb, x.theta1_rad[i], x.theta2_rad[i], &by_plain[i]);
                            }
                        },
                        [&](std::size_t i) { return six(by_plain[i]); }});
    versions.push_back({"Brace, one at a time",
                        [&](const Inputs &x, std::size_t n) {
                            for (std::size_t i = 0; i < n; i++) {
                                (void)brace_planar_stiffness(&tick, x.theta1_rad[i], x.theta2_rad[i], &by_tick[i]);
                            }
                        },
                        [&](std::size_t i) { return six(by_tick[i]); }});
    const auto by_columns = [](const brace_planar_t &model, Columns &out) {
        return [&](const Inputs &x, std::size_t n) {
            const std::size_t refused =
                brace_planar_batch(&model, n, x.theta1_rad.data(), x.theta2_rad.data(), &out.soa);
            require(refused == 0, "brace_planar_batch");
        };
    };
    versions.push_back({"Brace, batch", by_columns(batch, columns), [&](std::size_t i) { return columns.at(i); }});
    versions.push_back({"Brace, batch, tilted limb", by_columns(tilted_batch, tilted_columns),
                        [&](std::size_t i) { return tilted_columns.at(i); }});
    for (int round = 0; round < rounds; round++) {
        for (Version &version : versions) {
            for (const std::size_t batch_size : batch_sizes) {
                measure_round(version, in, batch_size);
            }
        }
    }
    for (const Version &version : versions) {
        print(version);
    }
    return 0;
}
