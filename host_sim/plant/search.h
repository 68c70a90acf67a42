// Leads the tip from where it is held to where it shall be held: in one part, or, where no rest is found so far away,
// in shorter ones. It sees how far each step of Newton's method moved the limb; it does not see the limb's model.
#pragma once

#include <algorithm>
#include <limits>

#include "plant/shape.h"

namespace brace::plant {

// One step of Newton's method. The forces are such as would move the limb along its softest direction so far.
struct Step {
    double moved_n;
    double rounding_n; // what rounding may move
    bool stable;       // it goes to a minimum of the energy
};

template <int N, class Rest> class Search {
public:
    using Vec = Vector<N>;

    static constexpr double kLost_n = std::numeric_limits<double>::infinity(); // moved by a step that went too far

    // linear: the first step is exact, and no part may be shorter than the whole.
    explicit Search(bool linear) : linear_(linear) {}

    bool seeks() const { return seeks_; }
    bool solved() const { return solved_; } // in the last search
    const Vec &target_mm() const { return target_mm_; }
    const Vec &part_target_mm() const { return part_target_mm_; } // where the present part ends
    const Vec &reached_mm() const { return reached_mm_; }         // where the tip is held now
    int free_axis() const { return free_axis_; }
    const Rest &began() const { return part_began_; } // rest where the present part began

    // The tip is held there, and nothing is sought.
    void end_at(const Vec &reached_mm, bool solved)
    {
        reached_mm_ = reached_mm;
        solved_ = solved;
        seeks_ = false;
    }

    // rest: where the tip is held now. foreseen: the steps begin elsewhere, and begin again at this rest if they lead
    // to none.
    void begin(const Vec &target_mm, int free_axis, const Rest &rest)
    {
        target_mm_ = target_mm;
        free_axis_ = free_axis;
        reached_share_ = 0.0;
        part_share_ = 1.0;
        part_began_ = rest;
        foreseen_ = false;
        seeks_ = true;
        begin_part();
    }
    void begins_foreseen() { foreseen_ = true; }

    // A step has led to `rest`. Where a part leads to none, `rest` becomes the one where that part began, and the next
    // part is half as long.
    void stepped(const Step &step, Rest &rest)
    {
        const Outcome so = outcome(step);
        if (so == Outcome::goes_on) {
            return;
        }
        if (so == Outcome::settled) {
            if (end_share_ == 1.0) {
                end_at(target_mm_, true);
                return;
            }
            part_began_ = rest;
            reached_share_ = end_share_;
        } else if (foreseen_) {
            rest = part_began_;
            foreseen_ = false;
        } else if (linear_) {
            end_at(target_mm_, false);
            return;
        } else {
            rest = part_began_;
            part_share_ *= 0.5;
            if (part_share_ < kShortestPart) {
                end_at(on_the_way_mm(reached_share_), false);
                return;
            }
        }
        begin_part();
    }

private:
    enum class Outcome { goes_on, settled, lost };

    static constexpr int kMostSteps = 12;
    static constexpr double kGoodMove_n = 1e-10; // a step that moves less is the last
    static constexpr double kPromisedMove_n = 1e-9; // it may move so much where rounding keeps it from becoming less
    static constexpr double kShortestPart = 1.0 / 64.0; // of the way to a displacement

    void begin_part()
    {
        end_share_ = std::min(1.0, reached_share_ + part_share_);
        part_target_mm_ = end_share_ == 1.0 ? target_mm_ : on_the_way_mm(end_share_);
        steps_ = 0;
        last_moved_n_ = kLost_n;
    }

    Vec on_the_way_mm(double share) const { return reached_mm_ + share * (target_mm_ - reached_mm_); }

    // Steps go on until the next one would move nothing.
    Outcome outcome(const Step &step)
    {
        const Outcome ended = step.stable ? Outcome::settled : Outcome::lost;
        if (linear_) {
            return ended;
        }
        const int before = steps_++;
        const double last_moved_n = last_moved_n_;
        last_moved_n_ = step.moved_n;
        if (!(step.moved_n < kLost_n)) {
            return Outcome::lost;
        }
        // Each step squares what is left, so the next one moves less than in proportion.
        if (step.moved_n <= kGoodMove_n || (before > 0 && step.moved_n * step.moved_n <= kGoodMove_n * last_moved_n)) {
            return ended;
        }
        if (before > 2 && step.moved_n > 0.5 * last_moved_n) {
            return step.moved_n <= std::max(kPromisedMove_n, step.rounding_n) ? ended : Outcome::lost;
        }
        return steps_ < kMostSteps ? Outcome::goes_on : Outcome::lost;
    }

    const bool linear_;
    bool seeks_ = false, solved_ = false, foreseen_ = false;
    Vec target_mm_ = Vec::Zero(), part_target_mm_ = Vec::Zero(), reached_mm_ = Vec::Zero();
    int free_axis_ = 0;
    // Shares of the way to the target: where rest was found, how long a part is, where the present one ends.
    double reached_share_ = 0.0, part_share_ = 1.0, end_share_ = 1.0;
    Rest part_began_{};
    int steps_ = 0; // in this part
    double last_moved_n_ = 0.0;
};

} // namespace brace::plant
