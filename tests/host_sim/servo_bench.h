// Three simulated servos, a driver, and a tick that reads the joints; the damage that a CRC misses.
#ifndef BRACE_SERVO_BENCH_H
#define BRACE_SERVO_BENCH_H

#include <array>
#include <cmath>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <vector>

extern "C" {
#include "api/brace_servos.h"
#include "brace_dynamixel.h"
#include "unity.h"
}

constexpr double kCountsPerRad = 4096.0 / (2.0 * M_PI);
constexpr std::uint64_t kTick_us = 1000, kStep_us = 50;
constexpr std::uint32_t kBaud = 3'000'000;
constexpr std::uint8_t kCoxa = 0, kFemur = 1, kTibia = 2;
constexpr std::uint8_t kIds[3] = {11, 12, 13};
constexpr std::uint16_t kModels[3] = {321, 1120, 1020};

// Three servos whose shafts turn, a driver, and a tick that reads the joints.
struct Bench {
    std::unique_ptr<brace_servos_t, void (*)(brace_servos_t *)> servos{brace_servos_create(kBaud, 1),
                                                                       brace_servos_destroy};
    brace_dynamixel_t driver{};
    brace_servo_setup_t setup{};
    std::uint64_t now_us = 0;
    std::uint64_t serve_us = 250; // how often there is time for the driver
    double turns_rad_per_s = 1.0;
    std::array<double, 3> beyond_turn_rad{};
    std::array<std::uint32_t, 3> fresh{}, wrong{}, refused{};
    std::uint64_t oldest_us = 0;
    bool is_deaf = false; // the line takes nothing
    bool has_echo = false; // the line hears itself
    std::vector<std::uint8_t> echo;
    std::vector<std::uint8_t> flips; // of the next answer of this length

    Bench()
    {
        for (int i = 0; i < 3; ++i) {
            TEST_ASSERT_EQUAL(i, brace_servos_add(servos.get(), kIds[i], kModels[i]));
            setup.joint[i] = {kIds[i], i == kTibia, 0.25f * static_cast<float>(i), 1.0f};
        }
        setup.period_us = 500;
        setup.timeout_us = 700;
        setup.holds = true;
        turn();
    }

    static std::int32_t send(void *context, const std::uint8_t *bytes, std::uint32_t count)
    {
        Bench &bench = *static_cast<Bench *>(context);
        if (bench.is_deaf) {
            return BRACE_HAL_AGAIN;
        }
        if (bench.has_echo) {
            bench.echo.assign(bytes, bytes + count);
        }
        brace_servos_hear(bench.servos.get(), 1000 * bench.now_us, bytes, count);
        return BRACE_HAL_OK;
    }

    static std::int32_t receive(void *context, std::uint8_t *bytes, std::uint32_t room)
    {
        Bench &bench = *static_cast<Bench *>(context);
        if (!bench.echo.empty()) {
            const auto heard = static_cast<std::ptrdiff_t>(std::min<std::size_t>(room, bench.echo.size()));
            std::copy_n(bench.echo.begin(), heard, bytes);
            bench.echo.erase(bench.echo.begin(), bench.echo.begin() + heard);
            return static_cast<std::int32_t>(heard);
        }
        const std::uint32_t count = brace_servos_give(bench.servos.get(), 1000 * bench.now_us, bytes, room);
        if (count == bench.flips.size()) {
            for (std::uint32_t i = 0; i < count; ++i) {
                bytes[i] ^= bench.flips[i];
            }
            bench.flips.clear();
        }
        return static_cast<std::int32_t>(count);
    }

    void start()
    {
        const brace_servo_line_t line = {this, send, receive};
        TEST_ASSERT_EQUAL(BRACE_HAL_OK, brace_dynamixel_start(&driver, &setup, &line));
    }

    double turned_rad(int joint, double t_us) const
    {
        return M_PI + beyond_turn_rad[joint] + 0.8 * std::sin(turns_rad_per_s * 1e-6 * t_us + joint);
    }
    double current_a(int joint, double t_us) const { return 1.2 * std::sin(3e-6 * t_us + 2 * joint); }

    void turn()
    {
        for (int i = 0; i < 3; ++i) {
            const double t_us = static_cast<double>(now_us);
            brace_servos_shaft(servos.get(), i, turned_rad(i, t_us), 0.5, current_a(i, t_us), 30 + i);
        }
    }

    // The servo read its encoder between the time it reports and the answer's last byte; half a step of the encoder.
    bool is_true(int joint, const brace_hal_joint_t &sample) const
    {
        const double from_us = sample.taken_us, to_us = from_us + 500, step_rad = 1 / kCountsPerRad;
        const double sense = setup.joint[joint].is_reversed ? -1 : 1;
        const double unit_n_mm = joint == kCoxa ? 3.36e-3 * 1615 : joint == kFemur ? 2.69e-3 * 2409 : 2.69e-3 * 1783;
        const double per_a_n_mm = unit_n_mm / (joint == kCoxa ? 3.36e-3 : 2.69e-3);
        const auto between = [](double value, double a, double b, double margin) {
            return value >= std::fmin(a, b) - margin && value <= std::fmax(a, b) + margin;
        };
        const double angle = (sample.link_rad - setup.joint[joint].zero_rad) * sense + M_PI;
        return between(angle, turned_rad(joint, from_us), turned_rad(joint, to_us), 0.51 * step_rad + 1e-6) &&
               between(sample.torque_n_mm * sense, per_a_n_mm * current_a(joint, from_us),
                       per_a_n_mm * current_a(joint, to_us), 0.51 * unit_n_mm) &&
               sample.motor_rad != sample.motor_rad;
    }

    void tick()
    {
        for (int i = 0; i < 3; ++i) {
            brace_hal_joint_t sample{};
            const std::int32_t answer = brace_dynamixel_read(&driver, i, &sample);
            refused[i] += answer < BRACE_HAL_AGAIN;
            if (answer == BRACE_HAL_OK) {
                ++fresh[i];
                wrong[i] += !is_true(i, sample);
            }
            if (answer == BRACE_HAL_OK || (answer == BRACE_HAL_AGAIN && sample.taken_us != 0)) {
                oldest_us = std::max(oldest_us, now_us - sample.taken_us);
            }
        }
    }

    void run(
        double seconds, const std::function<void()> &each_tick = [] {})
    {
        const std::uint64_t end_us = now_us + static_cast<std::uint64_t>(1e6 * seconds);
        for (; now_us < end_us; now_us += kStep_us) {
            turn();
            if (now_us % kTick_us == 0) {
                tick();
                each_tick();
            }
            if (now_us % serve_us == 0) {
                brace_dynamixel_serve(&driver, static_cast<std::uint32_t>(now_us));
            }
        }
    }

    void forget()
    {
        fresh = wrong = refused = {};
        oldest_us = 0;
    }

    brace_servo_report_t report(int joint) const
    {
        brace_servo_report_t reported{};
        brace_dynamixel_report(&driver, joint, &reported);
        return reported;
    }

    brace_servo_counters_t counters() const
    {
        brace_servo_counters_t reported{};
        brace_dynamixel_counters(&driver, &reported);
        return reported;
    }

    void be_ready()
    {
        start();
        run(0.1);
        for (int i = 0; i < 3; ++i) {
            TEST_ASSERT_EQUAL(BRACE_SERVO_READY, report(i).state);
        }
        forget();
    }

    // All joints stand; this one holds where it was commanded to.
    void hold_at(int joint, float angle_rad)
    {
        turns_rad_per_s = 0.0;
        be_ready();
        TEST_ASSERT_EQUAL(BRACE_HAL_OK, brace_dynamixel_move(&driver, joint, angle_rad));
        run(0.1);
    }

    void say(const char *what, double seconds) const
    {
        const brace_servo_counters_t reported = counters();
        std::printf("%s: %.0f %.0f %.0f samples/s, oldest at use %.2f ms, damaged %u, lost %u %u %u, doubted %u, "
                    "wrong %u\n",
                    what, fresh[0] / seconds, fresh[1] / seconds, fresh[2] / seconds,
                    1e-3 * static_cast<double>(oldest_us), reported.damaged, report(0).lost, report(1).lost,
                    report(2).lost, report(0).doubted + report(1).doubted + report(2).doubted,
                    wrong[0] + wrong[1] + wrong[2]);
    }
};

// The bursts of up to 16 bits that the CRC misses in an answer of this length, as bits to flip. The CRC is linear:
// it misses a burst if the CRC of the burst alone is 0, and the bytes of the answer make no difference.
inline std::vector<std::vector<std::uint8_t>> missed_bursts(std::size_t bytes)
{
    std::vector<std::vector<std::uint8_t>> missed;
    std::vector<std::uint16_t> of_bit(8 * bytes);
    std::vector<std::uint8_t> flips(bytes, 0);
    std::vector<std::uint16_t> remainder(1u << 15);
    for (std::size_t bit = 0; bit < of_bit.size(); ++bit) {
        flips[bit / 8] = static_cast<std::uint8_t>(1u << bit % 8);
        of_bit[bit] = static_cast<std::uint16_t>(dxl_crc(0, flips.data(), static_cast<std::uint32_t>(bytes) - 2) ^
                                                 flips[bytes - 2] ^ flips[bytes - 1] << 8);
        flips[bit / 8] = 0;
    }
    for (std::size_t begin = 0; begin < of_bit.size(); ++begin) {
        const std::size_t further = std::min<std::size_t>(15, of_bit.size() - 1 - begin);
        remainder[0] = of_bit[begin];
        for (std::uint32_t pattern = 0; pattern < 1u << further; ++pattern) {
            if (pattern != 0) { // as of the pattern without its lowest bit
                const auto lowest = static_cast<std::size_t>(__builtin_ctz(pattern));
                remainder[pattern] = remainder[pattern & (pattern - 1)] ^ of_bit[begin + 1 + lowest];
            }
            if (remainder[pattern] == 0) {
                std::vector<std::uint8_t> burst(bytes, 0);
                for (std::size_t i = 0; i <= further; ++i) {
                    if (((2 * pattern + 1) >> i & 1u) != 0) {
                        burst[(begin + i) / 8] ^= static_cast<std::uint8_t>(1u << (begin + i) % 8);
                    }
                }
                missed.push_back(burst);
            }
        }
    }
    return missed;
}

#endif
