#include "servo/line.h"

#include <algorithm>
#include <array>

namespace brace::servo {
namespace {

constexpr std::array<std::uint8_t, 4> kHeader = {0xff, 0xff, 0xfd, 0x00};
constexpr std::size_t kHeadBytes = 7; // header, id, length
constexpr std::uint8_t kBroadcast = 254, kStatus = 0x55, kSyncRead = 0x82, kSyncWrite = 0x83, kFastSyncRead = 0x8a,
                       kPing = 1;
constexpr std::uint64_t kThinks_ns = 10'000; // from an instruction's last bit to the answer's first, with no delay set
constexpr std::size_t kPacketMost = 1024;
constexpr std::int32_t kKnowsFast = 45; // firmware from which a servo knows the fast sync read

// Bit by bit, as the polynomial says: x^16 + x^15 + x^2 + 1.
std::uint16_t crc_of(const Bytes &bytes, std::size_t count)
{
    std::uint32_t crc = 0;
    for (std::size_t i = 0; i < count; ++i) {
        crc ^= static_cast<std::uint32_t>(bytes[i]) << 8;
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc & 0x8000u) != 0 ? (crc << 1) ^ 0x18005u : crc << 1;
        }
    }
    return static_cast<std::uint16_t>(crc);
}

void append_crc(Bytes &packet)
{
    const std::uint16_t crc = crc_of(packet, packet.size());
    packet.push_back(static_cast<std::uint8_t>(crc));
    packet.push_back(static_cast<std::uint8_t>(crc >> 8));
}

Bytes head(std::uint8_t id, std::size_t length)
{
    Bytes packet(kHeader.begin(), kHeader.end());
    packet.push_back(id);
    packet.push_back(static_cast<std::uint8_t>(length));
    packet.push_back(static_cast<std::uint8_t>(length >> 8));
    return packet;
}

bool ends_like_a_header(const Bytes &bytes)
{
    const std::size_t n = bytes.size();
    return n >= 3 && bytes[n - 3] == 0xff && bytes[n - 2] == 0xff && bytes[n - 1] == 0xfd;
}

Bytes stuffed(const Bytes &plain)
{
    Bytes out, since; // since: bytes that may make a header; what was stuffed in does not
    for (const std::uint8_t byte : plain) {
        out.push_back(byte);
        since.push_back(byte);
        if (ends_like_a_header(since)) {
            out.push_back(0xfd);
            since.clear();
        }
    }
    return out;
}

Bytes unstuffed(const Bytes &given)
{
    Bytes out, since;
    bool drops = false;
    for (const std::uint8_t byte : given) {
        if (drops && byte == 0xfd) {
            drops = false;
            since.clear();
            continue;
        }
        out.push_back(byte);
        since.push_back(byte);
        drops = ends_like_a_header(since);
    }
    return out;
}

std::uint16_t word(const Bytes &bytes, std::size_t at)
{
    return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
}

} // namespace

int Line::add(std::uint8_t id, std::uint16_t model)
{
    if (id > 252 || named(id) != nullptr) {
        return -1;
    }
    servos_.push_back(std::make_unique<Servo>(id, model));
    return static_cast<int>(servos_.size()) - 1;
}

Servo *Line::servo(std::int32_t index)
{
    return const_cast<Servo *>(static_cast<const Line *>(this)->servo(index));
}

const Servo *Line::servo(std::int32_t index) const
{
    const bool is_there = index >= 0 && index < static_cast<std::int32_t>(servos_.size());
    return is_there ? servos_[static_cast<std::size_t>(index)].get() : nullptr;
}

Servo *Line::named(std::uint8_t id)
{
    for (const auto &servo : servos_) {
        if (servo->id() == id) {
            return servo.get();
        }
    }
    return nullptr;
}

// ------------------------------------------------------------------------------------------------- the master

void Line::hear(std::uint64_t at_ns, Bytes bytes)
{
    if (at_ns < free_ns_ && !spoken_.empty()) {
        ++counts.collisions;
    }
    heard_ns_ = std::max(at_ns, heard_ns_) + byte_ns_ * bytes.size();
    heard_.insert(heard_.end(), bytes.begin(), bytes.end());
    while (true) {
        const auto begin = std::search(heard_.begin(), heard_.end(), kHeader.begin(), kHeader.end());
        if (begin == heard_.end()) {
            const auto kept = static_cast<std::ptrdiff_t>(std::min<std::size_t>(kHeader.size() - 1, heard_.size()));
            heard_.erase(heard_.begin(), heard_.end() - kept);
            return;
        }
        heard_.erase(heard_.begin(), begin);
        if (heard_.size() < kHeadBytes) {
            return;
        }
        const std::size_t whole = kHeadBytes + word(heard_, 5);
        if (whole < kHeadBytes + 3 || whole > kPacketMost) {
            heard_.erase(heard_.begin());
            continue;
        }
        if (heard_.size() < whole) {
            return;
        }
        const Bytes sent(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(whole));
        heard_.erase(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(whole));
        Bytes packet = sent;
        spoil(packet);
        if (crc_of(packet, whole - 2) != word(packet, whole - 2)) {
            Servo *meant = named(packet[4]);
            if (packet == sent && meant != nullptr && meant->hears(heard_ns_)) { // the master's own mistake
                say(*meant, {static_cast<std::uint8_t>(kCrc | meant->alert()), {}}, heard_ns_);
            }
            continue;
        }
        ++counts.heard;
        const Bytes plain = unstuffed({packet.begin() + 8, packet.end() - 2});
        obey(packet[4], packet[7], plain);
    }
}

void Line::obey(std::uint8_t id, std::uint8_t instruction, const Bytes &parameters)
{
    if (instruction == kStatus) {
        return;
    }
    if (id != kBroadcast) {
        if (Servo *meant = named(id); meant != nullptr && meant->hears(heard_ns_)) {
            if (const auto answer = meant->obey(instruction, parameters, heard_ns_)) {
                say(*meant, *answer, heard_ns_);
            }
        }
    } else if (instruction == kSyncRead || instruction == kFastSyncRead) {
        sync_read(parameters, instruction == kFastSyncRead);
    } else if (instruction == kSyncWrite) {
        sync_write(parameters);
    } else {
        std::vector<Servo *> in_order;
        for (const auto &servo : servos_) {
            in_order.push_back(servo.get());
        }
        std::sort(in_order.begin(), in_order.end(), [](const Servo *a, const Servo *b) { return a->id() < b->id(); });
        for (Servo *servo : in_order) {
            if (servo->hears(heard_ns_)) {
                const auto answer = servo->obey(instruction, parameters, heard_ns_);
                if (answer && instruction == kPing) { // nothing else is answered by all
                    say(*servo, *answer, heard_ns_);
                }
            }
        }
    }
}

void Line::sync_write(const Bytes &parameters)
{
    const std::size_t count = parameters.size() >= 4 ? word(parameters, 2) : 0;
    for (std::size_t at = 4; count > 0 && at + 1 + count <= parameters.size(); at += 1 + count) {
        if (Servo *meant = named(parameters[at]); meant != nullptr && meant->hears(heard_ns_)) {
            const auto data = parameters.begin() + static_cast<std::ptrdiff_t>(at) + 1;
            (void)meant->write(word(parameters, 0), {data, data + static_cast<std::ptrdiff_t>(count)});
        }
    }
}

// A servo answers when the one before it in the list has. Where one is silent, those behind it wait for ever.
void Line::sync_read(const Bytes &parameters, bool is_fast)
{
    if (parameters.size() < 5) {
        return;
    }
    const std::uint16_t address = word(parameters, 0), count = word(parameters, 2);
    const Bytes ids(parameters.begin() + 4, parameters.end());
    Bytes together = head(kBroadcast, 1 + ids.size() * (count + 4u));
    together.push_back(kStatus);
    std::vector<std::size_t> ends;
    std::uint64_t after_ns = heard_ns_;
    for (const std::uint8_t id : ids) {
        const Servo *meant = named(id);
        const bool hears = meant != nullptr && meant->hears(heard_ns_) && meant->get(kReturnLevel, 1) >= 1;
        if (!hears || (is_fast && meant->get(kFirmware, 1) < kKnowsFast)) {
            break;
        }
        Answer answer = meant->read(address, count);
        if (!is_fast) {
            say(*meant, answer, after_ns);
            continue;
        }
        answer.data.resize(count);
        together.push_back(answer.error);
        together.push_back(id);
        together.insert(together.end(), answer.data.begin(), answer.data.end());
        append_crc(together);
        after_ns += meant->return_delay_ns();
        ends.push_back(together.size());
    }
    if (!ends.empty()) {
        speak(together, after_ns);
    }
}

// ------------------------------------------------------------------------------------------------- the servos

void Line::say(const Servo &servo, const Answer &answer, std::uint64_t after_ns)
{
    Bytes plain = {kStatus, answer.error};
    plain.insert(plain.end(), answer.data.begin(), answer.data.end());
    const Bytes body = stuffed(plain);
    Bytes packet = head(servo.id(), body.size() + 2);
    packet.insert(packet.end(), body.begin(), body.end());
    append_crc(packet);
    speak(std::move(packet), after_ns + servo.return_delay_ns());
}

void Line::speak(Bytes packet, std::uint64_t after_ns)
{
    ++counts.answered;
    spoil(packet);
    std::uint64_t at_ns = std::max(after_ns, free_ns_) + kThinks_ns;
    for (const std::uint8_t byte : packet) {
        at_ns += byte_ns_;
        spoken_.push_back({at_ns, byte});
    }
    free_ns_ = at_ns;
}

// Up to three flipped bits anywhere, or a burst of up to 16 bits as the line has them: the lowest bit of a byte first.
void Line::spoil(Bytes &packet)
{
    if (damage_share <= 0.0 || std::uniform_real_distribution<double>()(random_) >= damage_share) {
        return;
    }
    ++counts.damaged;
    const auto below = [this](std::size_t most) {
        return std::uniform_int_distribution<std::size_t>(0, most - 1)(random_);
    };
    const auto flip = [&packet](std::size_t bit) { packet[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8); };
    const std::size_t bits = 8 * packet.size();
    if (below(2) == 0) {
        for (std::size_t left = 1 + below(3); left > 0; --left) {
            flip(below(bits));
        }
    } else {
        const std::size_t length = 2 + below(15), begin = below(bits - length);
        flip(begin);
        flip(begin + length - 1);
        for (std::size_t i = 1; i + 1 < length; ++i) {
            if (below(2) == 0) {
                flip(begin + i);
            }
        }
    }
}

std::uint32_t Line::give(std::uint64_t now_ns, std::uint8_t *bytes, std::uint32_t room)
{
    std::uint32_t given = 0;
    while (given < room && !spoken_.empty() && spoken_.front().at_ns <= now_ns) {
        bytes[given++] = spoken_.front().byte;
        spoken_.pop_front();
    }
    return given;
}

} // namespace brace::servo
