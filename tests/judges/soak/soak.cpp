// soak [TICKS [SEED [alone|blind]]]: four limbs and their controllers on one CAN bus, for TICKS of a millisecond of
// simulated time; 10,000,000 is ./dev soak's. Masters ask, send nonsense, hang up and come back; faults, postures,
// contacts, power cuts come at random. Each minute has 40 s of that and 20 s of calm. It fails when
//   a valid K is wrong by more than its uncertainty, or an open gap is not reported in the time that brace/app.h
//     promises
//   a request is not answered within 100 ticks in the calm, an answer is none, or its K is not the snapshot's
//   a controller is not back in MONITOR with a valid K and no fault 10 s after the trouble, or counts trouble then
//   the process keeps more memory or files in the last tenth than in the third
// "alone": no master asks, and there is no bus. K is judged in a sixth of the time, under other random events.
// "blind": the same without sensors at the tips, so that the joints measure every load.
//
// The simulation samples the motors first, and then lets the limb settle under what happens in the tick. So K may be
// right when the motors are sampled, and wrong a tick later, when the controller reports K. No motor's sensor could
// know that. Such K are counted separately. So are those of the tick after it, where only the motors measure the load:
// in one millisecond their inertia lets them move by next to nothing, so that their first sample is as before.
// While a sensor is stuck or off by a constant, wrong K are counted apart and do not fail the run: before the
// controller has detected the fault, it cannot know that the sensor is wrong.
// Stopped by SIGINT or SIGTERM, it reports what it has run. Exit code 0 when all is well.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <dirent.h>
#include <memory>

#include "limbs.h"
#include "masters.h"
#include "trouble.h"
#include "truth.h"

extern "C" {
#include "brace/app_memory.h"
}

namespace {

using namespace soak;

constexpr int kTenths = 10, kModbusMastersOfALimb = 3, kCanMasters = 3;
constexpr std::uint64_t kTick_us = 1000;
constexpr int kJudgedOnceIn = 149;  // ticks of a limb whose K is judged; just after something has happened all are
constexpr double kMemoryGrows_kb = 1024.0;
constexpr int kFilesOfMasters = 2 * (kLimbs * kModbusMastersOfALimb + kCanMasters); // both ends of every connection
constexpr std::uint32_t kGapSpare_ticks = 4; // brace/app.h: how long after its gap has opened a flank may be reported

struct Tenth {
    double memory_kb = 0.0, cpu_us = 0.0; // cpu_us: for one tick of four limbs, what judges and masters take included
    int files = 0;
    Answered modbus, can;
    std::uint64_t judged = 0;
    double worst = 0.0;
};

struct Found { // what must not be
    std::uint64_t wrong = 0, gaps_denied = 0, answers_wrong = 0, late_in_calm = 0, not_back = 0, counted_in_calm = 0;
    std::uint64_t sum() const
    {
        return wrong + gaps_denied + answers_wrong + late_in_calm + not_back + counted_in_calm;
    }
};

class Shares // of K's norm, to 0.005 %: a soak may not keep more and more
{
public:
    void take(double share)
    {
        ++bins_[static_cast<std::size_t>(std::min(share / kWidth, kBins - 1.0))];
        ++count_;
    }
    double percentile(double percent) const
    {
        std::uint64_t below = 0;
        std::size_t bin = 0;
        while (bin + 1u < bins_.size() &&
               100.0 * static_cast<double>(below + bins_[bin]) < percent * static_cast<double>(count_)) {
            below += bins_[bin++];
        }
        return count_ == 0u ? 0.0 : kWidth * (static_cast<double>(bin) + 0.5);
    }

private:
    static constexpr double kWidth = 5e-5, kBins = 4000.0;
    std::array<std::uint64_t, static_cast<std::size_t>(kBins)> bins_{};
    std::uint64_t count_ = 0;
};

struct Reported { // one sigma of the K that were judged
    Shares reported, by_parameters;
    std::uint64_t endless = 0; // the newest load is not known yet, or has no equilibrium
    void take(const Agreement &agreed)
    {
        reported.take(agreed.reported);
        by_parameters.take(agreed.by_parameters);
        endless += std::isinf(agreed.reported) ? 1u : 0u;
    }
    void report(const char *what) const
    {
        std::printf("sigma of K / its norm, %s: median %.3f %%, 99th percentile %.3f %%, endless %llu; by the "
                    "parameters alone %.3f %%, %.3f %%\n",
                    what, 100.0 * reported.percentile(50.0), 100.0 * reported.percentile(99.0),
                    static_cast<unsigned long long>(endless), 100.0 * by_parameters.percentile(50.0),
                    100.0 * by_parameters.percentile(99.0));
    }
};

struct Lies { // valid while a sensor lies, or did half a second ago
    std::uint64_t judged = 0, wrong = 0;
    double worst = 0.0;
};

double memory_kb()
{
    long pages = 0, resident = 0;
    if (FILE *file = std::fopen("/proc/self/statm", "r")) {
        if (std::fscanf(file, "%ld %ld", &pages, &resident) != 2) {
            resident = 0;
        }
        (void)std::fclose(file);
    }
    return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1024.0;
}

int open_files()
{
    int count = 0;
    if (DIR *folder = opendir("/proc/self/fd")) {
        while (readdir(folder) != nullptr) {
            ++count;
        }
        (void)closedir(folder);
    }
    return count;
}

struct Closed {
    void operator()(brace_node_t *node) const { brace_node_destroy(node); }
};

volatile std::sig_atomic_t is_stopped = 0;

void stop(int)
{
    is_stopped = 1;
}

unsigned long long number(std::uint64_t value) // for printf
{
    return value;
}

double mean_ticks(const Answered &answered)
{
    return static_cast<double>(answered.ticks_sum) / static_cast<double>(std::max<std::uint64_t>(1, answered.count));
}

class Soak {
public:
    Soak(std::uint64_t seed, bool is_alone, bool is_blind)
        : chance_(seed), limbs_(four_limbs(chance_)), is_alone_(is_alone)
    {
        std::array<brace_node_limb_t, kLimbs> there;
        std::array<std::array<std::uint8_t, BRACE_BLOCK_BYTES>, kLimbs> blocks;
        for (std::size_t i = 0; i < kLimbs; ++i) {
            if (brace_parameters_pack(&limbs_[i].believed, 1, blocks[i].data(), BRACE_BLOCK_BYTES) != BRACE_OK) {
                std::printf("soak: limb %zu has no parameters\n", i);
                std::exit(4);
            }
            there[i] = limbs_[i].there;
            there[i].modbus_tcp = is_alone ? nullptr : there[i].modbus_tcp;
            there[i].block = blocks[i].data();
            there[i].block_bytes = BRACE_BLOCK_BYTES;
        }
        brace_node_failure_t failure{};
        node_.reset(brace_node_create(there.data(), kLimbs, is_alone ? nullptr : "tcp://127.0.0.1:0", seed, &failure));
        if (node_ == nullptr) {
            std::printf("soak: no node: part %d, detail %d\n", static_cast<int>(failure.part), failure.detail);
            std::exit(4);
        }
        for (int limb = 0; limb < kLimbs && is_blind; ++limb) {
            (void)brace_node_fault(node_.get(), limb, BRACE_NODE_FAULT_FORCE_DEAD, 0, 0.0, 0.0, INFINITY);
        }
    }

    // returns how many of the ticks it has run
    std::uint64_t run(std::uint64_t ticks)
    {
        std::puts("| tenth | memory kB | files | processor us a tick of four | Modbus answers in the calm: number, "
                  "mean, most ticks | CAN answers | K judged | worst, of allowed |\n|---|---|---|---|---|---|---|---|");
        for (std::uint64_t tick = 0; tick < ticks; ++tick) {
            if (is_stopped != 0) {
                return tick;
            }
            Tenth &tenth = tenths_[static_cast<std::size_t>(tick * kTenths / ticks)];
            step(tenth, 1e-6 * static_cast<double>((tick + 1u) * kTick_us));
            if ((tick + 1u) * kTenths / ticks != tick * kTenths / ticks) {
                finish(tenth, ticks / kTenths);
            }
        }
        return ticks;
    }

    int report(std::uint64_t ticks, std::uint64_t seed) const;

private:
    void step(Tenth &tenth, double t_s);
    void judge(Tenth &tenth, std::size_t limb, double t_s);
    void judge_gaps(std::size_t limb, const brace_node_truth_t &truth, const brace_snapshot_t &reported, double t_s);
    void judge_calm(std::size_t limb, const brace_snapshot_t &reported, double t_s);
    void say(const char *what, std::size_t limb, double t_s, double share, const brace_snapshot_t &reported) const;
    void finish(Tenth &tenth, std::uint64_t ticks);

    Chance chance_;
    std::array<Limb, kLimbs> limbs_;
    bool is_alone_;
    std::unique_ptr<brace_node_t, Closed> node_;
    std::array<Trouble, kLimbs> trouble_;
    std::array<std::array<ModbusMaster, kModbusMastersOfALimb>, kLimbs> modbus_;
    std::array<CanMaster, kCanMasters> can_;
    std::array<Tenth, kTenths> tenths_;
    std::array<brace_app_counters_t, kLimbs> counters_{};
    std::array<bool, kLimbs> has_counters_{};
    std::array<brace_node_truth_t, kLimbs> truth_before_{};      // of the tick before
    std::array<brace_node_truth_t, kLimbs> truth_two_before_{};  // of the one before that
    Reported sensed_, unsensed_;
    std::uint64_t saved_ = 0;         // K that would be wrong were no more allowed than the parameters leave open
    std::uint64_t since_sampled_ = 0; // K that are wrong by what has happened since the motors were sampled
    std::uint64_t not_moved_ = 0; // and by what has happened a tick before, of which the motors have not yet moved
    std::array<std::uint32_t, kLimbs> denied_ticks_{}; // an open gap is not reported for so long
    std::uint32_t gap_reported_ticks_ = 0; // the longest
    std::clock_t since_ = std::clock();
    Found found_;
    Lies lies_;
    std::uint64_t valid_ = 0, ticks_seen_ = 0;
    int finished_ = 0; // tenths
    mutable int said_ = 0;
};

void Soak::step(Tenth &tenth, double t_s)
{
    for (int limb = 0; limb < kLimbs; ++limb) {
        trouble_[static_cast<std::size_t>(limb)].step(node_.get(), limb, t_s, chance_);
    }
    (void)brace_node_step(node_.get(), kTick_us);
    const bool is_settled = trouble_[0].is_settled(t_s);
    Answered can, modbus;
    for (std::size_t limb = 0; limb < kLimbs; ++limb) {
        for (ModbusMaster &master : modbus_[limb]) {
            if (is_alone_) {
                break;
            }
            const bool is_calm = trouble_[limb].is_calm(t_s);
            const bool is_right = master.step(node_.get(), static_cast<int>(limb), chance_, is_calm, modbus);
            found_.answers_wrong += is_right ? 0u : 1u;
        }
        judge(tenth, limb, t_s);
        truth_two_before_[limb] = truth_before_[limb];
        (void)brace_node_truth(node_.get(), static_cast<int>(limb), &truth_before_[limb]);
    }
    for (CanMaster &master : can_) {
        if (is_alone_) {
            break;
        }
        master.step(brace_node_can_place(node_.get()), chance_, trouble_[0].is_calm(t_s), can);
    }
    if (is_settled) { // in the calm: what is asked amid faults waits as long as they last
        found_.late_in_calm += modbus.late + can.late;
        for (auto [all, one] : {std::pair{&tenth.modbus, &modbus}, std::pair{&tenth.can, &can}}) {
            all->count += one->count;
            all->ticks_sum += one->ticks_sum;
            all->ticks_most = std::max(all->ticks_most, one->ticks_most);
        }
    }
}

void Soak::say(const char *what, std::size_t limb, double t_s, double share, const brace_snapshot_t &reported) const
{
    constexpr int kMostSaid = 40;
    if (said_++ < kMostSaid) {
        std::printf("%9.3f s, limb %s: %s; %.2f of what is allowed; mode %d, faults %x, flags %x\n", t_s,
                    limbs_[limb].name, what, share, static_cast<int>(reported.mode), reported.faults,
                    reported.stiffness.now.flags);
    }
}

void Soak::judge(Tenth &tenth, std::size_t limb, double t_s)
{
    brace_snapshot_t reported;
    brace_node_truth_t truth;
    (void)brace_node_snapshot(node_.get(), static_cast<int>(limb), &reported);
    (void)brace_node_truth(node_.get(), static_cast<int>(limb), &truth);
    ++ticks_seen_;
    valid_ += reported.k_is_valid ? 1u : 0u;
    judge_calm(limb, reported, t_s);
    judge_gaps(limb, truth, reported, t_s);
    const bool is_near = trouble_[limb].is_near(t_s);
    if (!is_near && whole(chance_, kJudgedOnceIn) != 0) {
        return;
    }
    brace_app_t *app = brace_node_app(node_.get(), static_cast<int>(limb));
    const Agreement agreed = agreement(limbs_[limb], truth, app);
    if (!agreed.is_judged) {
        return;
    }
    if (trouble_[limb].lies(t_s)) {
        ++lies_.judged;
        lies_.wrong += agreed.share > 1.0 ? 1u : 0u;
        lies_.worst = std::max(lies_.worst, agreed.share);
        return;
    }
    (agreed.is_sensed ? sensed_ : unsensed_).take(agreed);
    const auto was_right = [&](const brace_node_truth_t &then) {
        const Agreement found = agreement(limbs_[limb], then, app);
        return found.is_judged && found.share <= 1.0;
    };
    if (agreed.share > 1.0 && was_right(truth_before_[limb])) {
        ++since_sampled_;
        return;
    }
    if (agreed.share > 1.0 && !agreed.is_sensed && was_right(truth_two_before_[limb])) {
        ++not_moved_;
        return;
    }
    const bool is_open = (reported.stiffness.now.flags & BRACE_FLAG_GAP_OPEN) != 0u;
    saved_ += agreed.share_by_parameters > 1.0 && agreed.share <= 1.0 && !is_open ? 1u : 0u;
    ++tenth.judged;
    tenth.worst = std::max(tenth.worst, agreed.share);
    if (agreed.share > 1.0) {
        ++found_.wrong;
        say("a valid K is wrong", limb, t_s, agreed.share, reported);
    }
}

// A gap that is open, and a valid K that does not say so, for longer than the controller promises.
void Soak::judge_gaps(std::size_t limb, const brace_node_truth_t &truth, const brace_snapshot_t &reported, double t_s)
{
    const bool denies = reported.k_is_valid && !trouble_[limb].lies(t_s) && denies_gap(limbs_[limb], truth, reported);
    denied_ticks_[limb] = denies ? denied_ticks_[limb] + 1u : 0u;
    if (!denies) {
        return;
    }
    std::uint32_t most_us = 0;
    for (const int joint : {kFemur, kTibia}) {
        const brace_app_t *app = brace_node_app(node_.get(), static_cast<int>(limb));
        most_us = std::max(most_us, brace_backlash_detection_us(&app->controller.flank.joint[joint].machine));
    }
    gap_reported_ticks_ = std::max(gap_reported_ticks_, denied_ticks_[limb]);
    if (denied_ticks_[limb] > most_us / kTick_us + kGapSpare_ticks) {
        ++found_.gaps_denied;
        say("an open gap is not reported", limb, t_s, 1e3 * denied_ticks_[limb] / most_us, reported);
    }
}

// 10 s after the last trouble everything is as it was, and nothing more is counted.
void Soak::judge_calm(std::size_t limb, const brace_snapshot_t &reported, double t_s)
{
    if (!trouble_[limb].is_settled(t_s)) {
        has_counters_[limb] = false;
        return;
    }
    const bool is_back = reported.mode == BRACE_MODE_MONITOR && reported.k_is_valid && reported.faults == 0u;
    brace_app_counters_t now;
    brace_app_counters(brace_node_app(node_.get(), static_cast<int>(limb)), &now);
    if (!is_back) {
        ++found_.not_back;
        say("it is not back", limb, t_s, 0.0, reported);
    }
    if (has_counters_[limb] && std::memcmp(&now, &counters_[limb], sizeof now) != 0) {
        ++found_.counted_in_calm;
        say("it counts trouble in the calm", limb, t_s, 0.0, reported);
    }
    counters_[limb] = now;
    has_counters_[limb] = true;
}

void Soak::finish(Tenth &tenth, std::uint64_t ticks)
{
    const std::clock_t now = std::clock();
    tenth.cpu_us = 1e6 * static_cast<double>(now - since_) / CLOCKS_PER_SEC / static_cast<double>(ticks);
    since_ = now;
    tenth.memory_kb = memory_kb();
    tenth.files = open_files();
    std::printf("| %d | %.0f | %d | %.1f | %llu, %.2f, %u | %llu, %.2f, %u | %llu | %.2f |\n", ++finished_,
                tenth.memory_kb, tenth.files, tenth.cpu_us, number(tenth.modbus.count), mean_ticks(tenth.modbus),
                tenth.modbus.ticks_most, number(tenth.can.count), mean_ticks(tenth.can), tenth.can.ticks_most,
                number(tenth.judged), tenth.worst);
    (void)std::fflush(stdout);
}

int Soak::report(std::uint64_t ticks, std::uint64_t seed) const
{
    std::uint64_t events = 0, connections = 0, faults[BRACE_NODE_FAULT_COUNT] = {};
    for (std::size_t limb = 0; limb < kLimbs; ++limb) {
        events += trouble_[limb].events;
        for (int fault = 0; fault < BRACE_NODE_FAULT_COUNT; ++fault) {
            faults[fault] += trouble_[limb].faults[fault];
        }
        for (const ModbusMaster &master : modbus_[limb]) {
            connections += master.connections;
        }
    }
    for (const CanMaster &master : can_) {
        connections += master.connections;
    }
    std::printf("\nseed %llu, %llu ticks of four limbs, %.0f s of simulated time; %.1f %% of ticks with a valid K\n",
                number(seed), number(ticks), 1e-3 * static_cast<double>(ticks),
                100.0 * static_cast<double>(valid_) / static_cast<double>(std::max<std::uint64_t>(1, ticks_seen_)));
    std::printf("%llu events, %llu connections; faults:", number(events), number(connections));
    for (int fault = 0; fault < BRACE_NODE_FAULT_COUNT; ++fault) {
        std::printf(" %s %llu", brace_node_fault_name(fault), number(faults[fault]));
    }
    brace_node_stats_t stats;
    brace_node_stats(node_.get(), &stats);
    std::printf("\nwhile a sensor lies: %llu valid K judged, %llu beyond their uncertainty, the worst %.2f of what is "
                "allowed\n",
                number(lies_.judged), number(lies_.wrong), lies_.worst);
    sensed_.report("load sensed at the tip");
    unsensed_.report("load by the joints");
    std::printf("K right only because the load's lag is reported: %llu\n", number(saved_));
    std::printf("K wrong only by what has happened since their motors were sampled: %llu; or a tick before, when the "
                "motors had not yet moved: %llu\n",
                number(since_sampled_), number(not_moved_));
    std::printf("an open gap was reported after %u ticks at most\n", gap_reported_ticks_);
    std::printf("wrong K %llu, gaps denied %llu, wrong answers %llu, late in the calm %llu, not back %llu, "
                "counted in the calm %llu, watchdog resets %u\n",
                number(found_.wrong), number(found_.gaps_denied), number(found_.answers_wrong),
                number(found_.late_in_calm), number(found_.not_back), number(found_.counted_in_calm),
                stats.watchdog_resets);
    const Tenth &first = tenths_[2], &last = tenths_[static_cast<std::size_t>(std::max(finished_, 3) - 1)];
    const double grows_kb = last.memory_kb - first.memory_kb;
    const bool is_flat = grows_kb <= kMemoryGrows_kb && last.files <= first.files + kFilesOfMasters;
    std::printf("memory from the third tenth to the last: %+.0f kB\n", grows_kb);
    return found_.sum() == 0u && stats.watchdog_resets == 0u && is_flat ? 0 : 1;
}

} // namespace

int main(int count, char **arguments)
{
    const std::uint64_t ticks = count > 1 ? std::strtoull(arguments[1], nullptr, 10) : 120000u;
    const std::uint64_t seed = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1u;
    if (ticks < 10u) {
        std::printf("soak: %s ticks: at least 10\n", arguments[1]);
        return 2;
    }
    (void)std::signal(SIGINT, stop);
    (void)std::signal(SIGTERM, stop);
    const bool is_blind = count > 3 && std::strcmp(arguments[3], "blind") == 0;
    const bool is_alone = is_blind || (count > 3 && std::strcmp(arguments[3], "alone") == 0);
    Soak soak(seed, is_alone, is_blind);
    const std::uint64_t run = soak.run(ticks);
    return soak.report(run, seed);
}
