// Four limbs carry a body of 30 N. What does each foot bear, with a payload and with a foot off the ground, and which
// foot slips first? A robot's loop asks this at each new set of K. CMakeLists.txt says how to build it.
#include <array>
#include <cstdint>
#include <cstdio>

#include "brace/stance.h"

namespace {
struct Limb {
    const char *name;
    double x_mm, y_mm; // of the tip without load, from the body's origin: by the posture that the controller sends
    double k_n_per_mm; // K comes from the bus (docs/client.md) and has nine numbers. Here it is alike in all directions
    double friction_ratio;
};
constexpr std::array<Limb, 4> limbs{{{"front left", 120.0, 90.0, 4.0, 0.6},
                                     {"front right", 120.0, -90.0, 4.0, 0.5},
                                     {"rear left", -120.0, 90.0, 4.0, 0.6},
                                     {"rear right", -120.0, -90.0, 4.0, 0.6}}};
constexpr int32_t slide_steps = 8;

brace_stance_t stance_of_limbs()
{
    brace_stance_t stance{};
    for (const Limb &limb : limbs) {
        brace_stance_limb_t &to = stance.limb[stance.limb_count++];
        to.foot_mm[0] = limb.x_mm;
        to.foot_mm[1] = limb.y_mm; // z stays 0: this body hangs as low as its feet stand
        for (int i = 0; i < 3; i++) {
            to.k_n_per_mm[4 * i] = limb.k_n_per_mm;
        }
        to.normal[2] = 1.0; // a floor that the feet only press on
        to.friction_ratio = limb.friction_ratio;
    }
    return stance;
}

// What a status asks of the robot: no rest is an answer, a loose body needs more feet, wrong input is a program fault.
bool is_ok(const char *doing, int32_t status)
{
    if (status == BRACE_STANCE_E_NO_REST) {
        std::printf("%s: the limbs cannot bear this (%s); do not do it\n", doing, brace_stance_status_text(status));
    } else if (status == BRACE_STANCE_E_LOOSE) {
        std::printf("%s: %s; put another foot down first\n", doing, brace_stance_status_text(status));
    } else if (status != BRACE_STANCE_OK) {
        std::printf("%s: %s; look at K, normals and friction\n", doing, brace_stance_status_text(status));
    }
    return status == BRACE_STANCE_OK;
}

void print(const char *when, const brace_stance_t &stance, const brace_stance_state_t &state)
{
    for (std::size_t i = 0; i < limbs.size(); i++) {
        const double *force_n = state.foot[i].force_n;
        std::printf("%s, %s: force %.3f %.3f %.3f N, margin %.3f N\n", when, limbs[i].name, force_n[0], force_n[1],
                    force_n[2], brace_stance_margin_n(&stance.limb[i], force_n));
    }
}
} // namespace

int main()
{
    const brace_stance_t stance = stance_of_limbs();
    brace_stance_state_t state{};
    brace_stance_load_t load{}, pull{};
    const double origin_mm[3]{}, payload_at_mm[3]{-60.0, 0.0, 0.0};
    const double weight_n[3]{0.0, 0.0, -30.0}, payload_n[3]{0.0, 0.0, -10.0}, pull_n[3]{1.0, 0.0, 0.0};

    brace_stance_load_add(&load, weight_n, origin_mm);
    if (!is_ok("place", brace_stance_place(&stance, nullptr, &state)) ||
        !is_ok("put down", brace_stance_settle(&stance, &load, slide_steps, &state, nullptr))) {
        return 1;
    }
    print("weight", stance, state);

    brace_stance_load_add(&load, payload_n, payload_at_mm); // loads are whole: weight and payload
    if (!is_ok("payload", brace_stance_settle(&stance, &load, slide_steps, &state, nullptr))) {
        return 1;
    }
    print("payload", stance, state);

    brace_stance_slip_t slip{};
    brace_stance_load_add(&pull, pull_n, origin_mm);
    if (is_ok("pull", brace_stance_first_slip(&stance, &pull, 1000.0, &state, &slip)) && slip.limb >= 0) {
        const char *first = limbs[static_cast<std::size_t>(slip.limb)].name;
        std::printf("first to move: %s, at a pull of %.3f N\n", first, slip.factor);
    }

    for (int32_t foot : {0, 2}) { // a copy of the state is tried: the robot has not lifted anything yet
        brace_stance_state_t tried = state;
        brace_stance_lift(&tried, foot);
        const int32_t status = brace_stance_settle(&stance, &load, slide_steps, &tried, nullptr);
        if (is_ok(limbs[static_cast<std::size_t>(foot)].name, status)) {
            print("lifted", stance, tried);
        }
    }
    return 0;
}
