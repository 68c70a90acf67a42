#include "plant/loading.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>

#include "effects/memory.h"
#include "plant/limbs_abreast.h"
#include "plant/sensor.h"

namespace brace::plant {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kMostLookedBack = 100; // runs: more than a record of ten postures has

constexpr int kMostPresses = 60;
constexpr double kPressed_n = 1e-7; // what may be left of the preload
constexpr double kAside_mm = 1e-3;  // of the differences that show how the force grows

struct Pressed {
    Vector2d displacement_mm;
    bool solved;
};

// Where the tip rests under a force. A limb that has just begun its run goes there in one move, so that friction and
// play are as that move leaves them; each try is made on a copy. Newton's method, with steps that halve where they lead
// away.
Pressed pressed(const LimbState<InPlane> &limb, const Vector2d &force_n)
{
    const auto lacks_at = [&](const Vector2d &displacement_mm, bool &solved) -> Vector2d {
        LimbState<InPlane> trial = limb;
        const LimbRest<2> rest = trial.hold_tip(displacement_mm);
        solved = rest.solved;
        return force_n - rest.force_n;
    };
    bool solved = false;
    Vector2d at_mm = Vector2d::Zero();
    Vector2d lacks_n = lacks_at(at_mm, solved);
    for (int i = 0; i < kMostPresses && solved && lacks_n.norm() > kPressed_n; ++i) {
        Eigen::Matrix2d slope_n_per_mm;
        for (int axis = 0; axis < 2; ++axis) {
            bool there = false;
            const Vector2d aside_mm = at_mm + kAside_mm * Vector2d::Unit(axis);
            slope_n_per_mm.col(axis) = (lacks_n - lacks_at(aside_mm, there)) / kAside_mm;
            solved = solved && there;
        }
        const Vector2d step_mm = slope_n_per_mm.inverse() * lacks_n;
        if (!solved || !step_mm.allFinite()) {
            return {at_mm, false};
        }
        bool closer = false;
        for (double share = 1.0; !closer && share > 1e-3; share *= 0.5) {
            const Vector2d next_mm = at_mm + share * step_mm;
            bool there = false;
            const Vector2d next_n = lacks_at(next_mm, there);
            closer = there && next_n.norm() < lacks_n.norm();
            if (closer) {
                at_mm = next_mm;
                lacks_n = next_n;
            }
        }
        solved = closer;
    }
    return {at_mm, solved && lacks_n.norm() <= kPressed_n};
}

} // namespace

Loading::Loading(const brace_loading_rows_t &rows) : rows_(rows), rests_(rows.count)
{
    now_.of_row.resize(rows.count);
    last_.of_row.resize(rows.count);
    for (std::size_t i = 0; i < rows.count; ++i) {
        if (i > 0 && rows.run[i] == rows.run[i - 1]) {
            ++runs_.back().end;
        } else {
            runs_.push_back({i, i + 1, i, false});
        }
    }
    for (std::size_t r = 1; r < runs_.size(); ++r) {
        Run &run = runs_[r];
        for (std::size_t back = 1; back <= std::min(r, kMostLookedBack); ++back) {
            const Run &before = runs_[r - back];
            if (before.end - before.first == run.end - run.first && goes_like(run, before.first)) {
                run.earlier = before.first;
                run.same_pace = true;
                for (std::size_t i = 1; i < run.end - run.first; ++i) {
                    run.same_pace = run.same_pace
                                    && rows.t_s[run.first + i] - rows.t_s[run.first + i - 1]
                                           == rows.t_s[run.earlier + i] - rows.t_s[run.earlier + i - 1];
                }
                break;
            }
        }
    }
}

bool Loading::goes_like(const Run &run, std::size_t earlier) const
{
    const auto same = [&](const auto *column) {
        return column == nullptr || std::equal(column + run.first, column + run.end, column + earlier);
    };
    return same(rows_.theta1_rad) && same(rows_.theta2_rad) && same(rows_.dx_mm) && same(rows_.dz_mm)
           && same(rows_.free_axis) && same(rows_.preload_x_n) && same(rows_.preload_z_n);
}

// Rows that share one need no look at its numbers.
bool Loading::is_same_limb(const Limbs &a, std::size_t row_a, const Limbs &b, std::size_t row_b)
{
    const effects::Model &one = a.limb[a.of_row[row_a]], &other = b.limb[b.of_row[row_b]];
    return &one == &other || effects::is_same(one, other);
}

bool Loading::rests_like_earlier(const Run &run) const
{
    if (run.earlier == run.first || (remembers_pace_ && !(run.same_pace && rows_.creep_runs_on == 0))) {
        return false;
    }
    for (std::size_t i = run.first; i < run.end && now_.limb.size() > 1; ++i) {
        if (!is_same_limb(now_, i, now_, run.earlier + (i - run.first))) {
            return false;
        }
    }
    return true;
}

// A search for the time at which a link changes plays the runs before and after it once.
bool Loading::rests_like_last(const Run &run) const
{
    if (!known_ || (remembers_pace_ && rows_.creep_runs_on != 0)) {
        return false;
    }
    for (std::size_t i = run.first; i < run.end; ++i) {
        if (!is_same_limb(now_, i, last_, i)) {
            return false;
        }
    }
    return true;
}

effects::Conditions Loading::conditions(const effects::Model &model, std::size_t row) const
{
    return {rows_.t_s[row], rows_.temp_degc != nullptr ? rows_.temp_degc[row] : model.thermal.reference_degc};
}

void Loading::find_limbs(const effects::Model &model)
{
    std::swap(last_, now_);
    now_.limb.clear();
    std::fill(now_.of_row.begin(), now_.of_row.end(), 0);
    const std::size_t may_differ = effects::Changes::act(model) ? rows_.count : std::min<std::size_t>(rows_.count, 1);
    now_.limb.reserve(may_differ);
    for (std::size_t i = 0; i < may_differ; ++i) {
        const effects::Model limb = effects::limb_now(model, conditions(model, i));
        if (now_.limb.empty() || !effects::is_same(limb, now_.limb.back())) {
            now_.limb.push_back(limb);
        }
        now_.of_row[i] = now_.limb.size() - 1;
    }
}

bool Loading::find_rests(const effects::Model &model)
{
    find_limbs(model);
    remembers_pace_ = rows_.count > 0 && effects::remembers_pace(now_.limb.front());
    std::vector<const Run *> played, copied;
    for (const Run &run : runs_) {
        if (!rests_like_last(run)) {
            (rests_like_earlier(run) ? copied : played).push_back(&run);
        }
    }
    known_ = false;
    const bool remembers_runs = rows_.creep_runs_on != 0 && remembers_pace_;
    const bool in_turn = rows_.small_displacements != 0 || remembers_runs || played.size() < 2;
    if (!(in_turn ? play_in_turn(model, played) : play_abreast(model, played))) {
        return false;
    }
    for (const Run *run : copied) {
        for (std::size_t i = run->first; i < run->end; ++i) {
            rests_[i] = rests_[run->earlier + (i - run->first)];
        }
    }
    known_ = true;
    return true;
}

bool Loading::begin_row(Player &player, const effects::Model &model, LimbState<InPlane> &limb) const
{
    const std::size_t i = player.row;
    if (!limb.move_to(rows_.theta1_rad[i], rows_.theta2_rad[i], conditions(model, i))) {
        return false;
    }
    const Vector2d displacement_mm(rows_.dx_mm[i], rows_.dz_mm[i]);
    player.begins_at_rest = true;
    if (i == player.run->first) {
        limb.start_run(rows_.creep_runs_on == 0);
        player.begins_at_rest = rows_.held_at_rest == 0 || limb.hang();
        player.aside_mm.setZero();
        if (rows_.preload_x_n != nullptr) {
            const Pressed rest = pressed(limb, {rows_.preload_x_n[i], rows_.preload_z_n[i]});
            player.aside_mm = rest.displacement_mm - displacement_mm;
            player.begins_at_rest = player.begins_at_rest && rest.solved;
        }
    }
    limb.begin_hold(displacement_mm + player.aside_mm, rows_.free_axis != nullptr ? rows_.free_axis[i] : 0);
    return true;
}

void Loading::end_row(Player &player, LimbState<InPlane> &limb)
{
    LimbRest<2> &rest = rests_[player.row++];
    rest = limb.end_hold();
    rest.solved = rest.solved && player.begins_at_rest;
}

bool Loading::play_in_turn(const effects::Model &model, const std::vector<const Run *> &runs)
{
    LimbState<InPlane> limb(model, rows_.small_displacements != 0 ? Displacements::small : Displacements::finite);
    for (const Run *run : runs) {
        for (Player player{run, run->first, Vector2d::Zero(), true}; player.row < run->end;) {
            if (!begin_row(player, model, limb)) {
                return false;
            }
            limb.seek();
            end_row(player, limb);
        }
    }
    return true;
}

// A limb that is at rest goes on with its next row, or with the next run that nobody plays.
bool Loading::play_abreast(const effects::Model &model, const std::vector<const Run *> &runs)
{
    LimbsAbreast limbs(model);
    std::array<Player, kLanes> players{};
    auto next = runs.begin();
    for (bool some_seek = true; some_seek;) {
        some_seek = false;
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            Player &player = players[lane];
            LimbState<InPlane> &limb = limbs.limb(lane);
            while (!limb.seeks()) {
                if (player.run != nullptr) {
                    end_row(player, limb);
                }
                if (player.run == nullptr || player.row == player.run->end) {
                    player.run = next != runs.end() ? *next++ : nullptr;
                    if (player.run == nullptr) {
                        break;
                    }
                    player.row = player.run->first;
                }
                if (!begin_row(player, model, limb)) {
                    return false;
                }
            }
            some_seek = some_seek || limb.seeks();
        }
        if (some_seek) {
            limbs.step();
        }
    }
    return true;
}

std::size_t Loading::read(const effects::Model &model, const brace_loading_reading_t &reading) const
{
    const Sensor sensor(model);
    std::size_t unsolved_rows = 0;
    for (const Run &run : runs_) {
        Vector2d zero_n = Vector2d::Zero();
        for (std::size_t i = run.first; i < run.end; ++i) {
            const LimbRest<2> &rest = rests_[i];
            unsolved_rows += rest.solved ? 0 : 1;
            Vector2d read_n = sensor.reading_n(rest.force_n, rows_.t_s[i]);
            if (i == run.first && rows_.zeroed_per_run != 0) {
                zero_n = read_n;
            }
            read_n -= zero_n;
            const auto write = [i](double *column, double value) {
                if (column != nullptr) {
                    column[i] = value;
                }
            };
            write(reading.fx_n, read_n.x());
            write(reading.fz_n, read_n.y());
            write(reading.enc1_rad, rest.joint_deflection_rad[0]);
            write(reading.enc2_rad, rest.joint_deflection_rad[1]);
            write(reading.base_x_mm, rest.base_mm.x());
            write(reading.base_z_mm, rest.base_mm.y());
        }
    }
    return unsolved_rows;
}

brace_host_status_t Loading::play(const effects::Model &model, const brace_loading_reading_t &reading,
                                  std::size_t &unsolved_rows)
{
    if (!find_rests(model)) {
        return BRACE_HOST_E_SINGULAR;
    }
    unsolved_rows = read(model, reading);
    return unsolved_rows == 0 ? BRACE_HOST_OK : BRACE_HOST_E_NO_CONVERGENCE;
}

} // namespace brace::plant
