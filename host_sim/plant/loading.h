// A loading record played on limbs, row by row.
#pragma once

#include <cstddef>
#include <vector>

#include "effects/effect.h"
#include "plant/limb_state.h"

namespace brace::plant {

class Loading {
public:
    // Inputs must be sound (see api/loading.cpp), and live as long as this.
    explicit Loading(const brace_loading_rows_t &rows);

    // Brings the limb to rest in every row. false: nothing yields in some direction.
    bool find_rests(const effects::Model &model);

    // What the model's sensor reads of the rests found last; writes every row it has room for. Counts the rows without
    // rest.
    std::size_t read(const effects::Model &model, const brace_loading_reading_t &reading) const;

    // Both.
    // returns OK, E_SINGULAR (nothing written), E_NO_CONVERGENCE
    brace_host_status_t play(const effects::Model &model, const brace_loading_reading_t &reading,
                             std::size_t &unsolved_rows);

private:
    // A limb that remembers nothing from run to run rests in a run just as in an earlier one that went the same way.
    struct Run {
        std::size_t first, end;
        std::size_t earlier; // first row of the run that went this way before; `first` where none did
        bool same_pace; // and took the same time from row to row
    };

    // A limb in a row of a run, which begins with what its rig did.
    struct Player {
        const Run *run;
        std::size_t row;
        Eigen::Vector2d aside_mm; // where the tip stands more than the record says, for its preload
        bool begins_at_rest; // false in a run's first row only
    };

    // Plays runs one after the other, or some of them side by side. false: nothing yields in some direction.
    bool play_in_turn(const effects::Model &model, const std::vector<const Run *> &runs);
    bool play_abreast(const effects::Model &model, const std::vector<const Run *> &runs);
    bool begin_row(Player &player, const effects::Model &model, LimbState<InPlane> &limb) const;
    void end_row(Player &player, LimbState<InPlane> &limb);

    // The limb as it is in each row.
    struct Limbs {
        std::vector<effects::Model> limb; // as many as differ from the one before
        std::vector<std::size_t> of_row;
    };

    effects::Conditions conditions(const effects::Model &model, std::size_t row) const;
    void find_limbs(const effects::Model &model);
    static bool is_same_limb(const Limbs &a, std::size_t row_a, const Limbs &b, std::size_t row_b);
    bool goes_like(const Run &run, std::size_t earlier) const;
    bool rests_like_earlier(const Run &run) const;
    bool rests_like_last(const Run &run) const;

    const brace_loading_rows_t &rows_;
    std::vector<Run> runs_;
    std::vector<LimbRest<2>> rests_;
    Limbs now_;
    Limbs last_; // whose rests they are, if known_
    bool known_ = false;
    bool remembers_pace_ = false;
};

} // namespace brace::plant
