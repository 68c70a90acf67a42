/* Which controller of the process takes a frame. */
#include "posix_nodes.h"

uint32_t bus_bit_rate(const brace_posix_bus_t *bus)
{
    for (uint32_t i = 0; i < BRACE_POSIX_NODES; i++) {
        if (bus->node[i].used && bus->node[i].on) {
            return bus->node[i].setup.bit_rate;
        }
    }
    return 0;
}

bool bus_is_urgent(const brace_posix_bus_t *bus, const brace_posix_wire_frame_t *frame)
{
    bool is_urgent = false;
    for (uint32_t i = 0; i < BRACE_POSIX_NODES; i++) {
        const brace_posix_node_t *node = &bus->node[i];
        is_urgent = is_urgent || (node->used && node->on && frame->frame.id == node->setup.urgent_id);
    }
    return is_urgent && frame->frame.id != 0u && !frame->extended && !frame->remote;
}

void node_takes(brace_posix_node_t *node, const brace_can_frame_t *frame)
{
    if (node->setup.urgent_id != 0u && frame->id == node->setup.urgent_id) {
        node->urgent = *frame;
        node->has_urgent = true;
        node->received++;
        return;
    }
    if (((frame->id ^ node->setup.filter_id) & node->setup.filter_mask) != 0u) {
        return;
    }
    if (node->count == BRACE_POSIX_RING) {
        node->frames_lost += node->frames_lost != UINT32_MAX;
        return;
    }
    node->ring[(node->start + node->count++) % BRACE_POSIX_RING] = *frame;
    node->received++;
}

void bus_to_nodes(brace_posix_bus_t *bus, int32_t sender, const brace_posix_wire_frame_t *frame, uint32_t bit_rate)
{
    if (frame->extended || frame->remote) {
        return; /* the door has no such frames */
    }
    for (int32_t i = 0; i < BRACE_POSIX_NODES; i++) {
        brace_posix_node_t *node = &bus->node[i];
        const bool same_rate = bit_rate == 0u || bit_rate == node->setup.bit_rate;
        const bool takes_fd = !frame->frame.fd || node->setup.fd_bit_rate > 0u;
        if (i != sender && node->used && node->on && !node->bus_off && !node->setup.loopback && same_rate && takes_fd) {
            node_takes(node, &frame->frame);
        }
    }
}
