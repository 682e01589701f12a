#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

// MCAP and CDR written by hand, number by number, without any code of this room.

namespace ironbird::scenarios::by_hand {

/// The low `size` bytes of a number, least significant first.
inline std::string number(std::uint64_t value, int size) {
  std::string bytes;
  for (int i = 0; i < size; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xFF);
  return bytes;
}
inline std::string u8(std::uint64_t value) {
  return number(value, 1);
}
inline std::string u16(std::uint64_t value) {
  return number(value, 2);
}
inline std::string u32(std::uint64_t value) {
  return number(value, 4);
}
inline std::string u64(std::uint64_t value) {
  return number(value, 8);
}
inline std::string f64(double value) {
  return u64(std::bit_cast<std::uint64_t>(value));
}
inline std::string pad(int count) {
  return std::string(static_cast<std::size_t>(count), '\0');
}
inline std::string text(const std::string& value) {
  return u32(value.size()) + value;
}
inline std::string record(int opcode, const std::string& content) {
  return u8(static_cast<std::uint64_t>(opcode)) + u64(content.size()) + content;
}
inline std::string magic() {
  return std::string("\x89MCAP0\r\n", 8);
}

inline std::string header() {
  return record(0x01, text("ros2") + text("ironbird"));
}
inline std::string schema(int id, const std::string& name, const std::string& definition) {
  return record(0x03, u16(static_cast<std::uint64_t>(id)) + text(name) + text("ros2msg") + text(definition));
}
inline std::string channel(int id, int schema_id, const std::string& topic, const std::string& map = "") {
  return record(0x04, u16(static_cast<std::uint64_t>(id)) + u16(static_cast<std::uint64_t>(schema_id)) +
                          text(topic) + text("cdr") + text(map));
}
inline std::string message(int channel_id, std::uint32_t sequence, std::uint64_t time,
                           const std::string& data) {
  return record(0x05,
                u16(static_cast<std::uint64_t>(channel_id)) + u32(sequence) + u64(time) + u64(time) + data);
}
inline std::string chunk(std::uint64_t first, std::uint64_t last, const std::string& records,
                         std::uint32_t crc, const std::string& compression = "",
                         std::uint64_t uncompressed = 0) {
  return record(0x06, u64(first) + u64(last) + u64(compression.empty() ? records.size() : uncompressed) +
                          u32(crc) + text(compression) + u64(records.size()) + records);
}
inline std::string footer(std::uint64_t summary, std::uint64_t offsets, std::uint32_t crc) {
  return record(0x02, u64(summary) + u64(offsets) + u32(crc));
}

/// CRC-32 bit by bit, straight from its definition.
inline std::uint32_t crc(const std::string& bytes) {
  std::uint32_t value = 0xFFFFFFFFu;
  for (const char byte : bytes) {
    value ^= static_cast<std::uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) value = (value & 1u) != 0 ? (value >> 1) ^ 0xEDB88320u : value >> 1;
  }
  return ~value;
}

inline std::filesystem::path write_file(const std::filesystem::path& file, const std::string& bytes) {
  // Overwriting a file makes some file systems wait for the disk.
  std::filesystem::remove(file);
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}
inline std::string read_file(const std::filesystem::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes.str();
}

}  // namespace ironbird::scenarios::by_hand
