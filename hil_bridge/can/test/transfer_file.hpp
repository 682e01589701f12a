#pragma once

#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "hil_bridge/can/dronecan_transfer.hpp"
#include "hil_bridge/can/test/frame_text.hpp"

// The transfers of test/transfers.csv: made by two foreign implementations of DroneCAN, of which one wrote
// the payloads and the other cut them into the same frames.

namespace ironbird::hil_bridge::can {

struct RecordedTransfer {
  std::string type;
  std::string values;
  TransferHead head;
  std::uint64_t signature = 0;
  std::vector<std::uint8_t> payload;
  std::vector<CanFrame> frames;
};

inline std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char letter : line) {
    if (letter == '"') {
      quoted = !quoted;
    } else if (letter == ',' && !quoted) {
      cells.emplace_back();
    } else if (letter != '\r') {
      cells.back() += letter;
    }
  }
  return cells;
}

inline RecordedTransfer transfer_of(const std::vector<std::string>& cells) {
  const auto number = [&](std::size_t cell) { return cells[cell].empty() ? 0 : std::stoi(cells[cell]); };
  RecordedTransfer transfer;
  transfer.type = cells[0];
  transfer.values = cells[1];
  transfer.head.kind = cells[2] == "request"    ? TransferKind::kRequest
                       : cells[2] == "response" ? TransferKind::kResponse
                                                : TransferKind::kMessage;
  transfer.head.data_type_id = static_cast<std::uint16_t>(number(3));
  transfer.signature = std::stoull(cells[4], nullptr, 16);
  transfer.head.priority = static_cast<std::uint8_t>(number(5));
  transfer.head.source = static_cast<std::uint8_t>(number(6));
  transfer.head.destination = static_cast<std::uint8_t>(number(7));
  transfer.head.transfer_id = static_cast<std::uint8_t>(number(8));
  transfer.payload = bytes_of(cells[9]);
  std::string_view rest = cells[10];
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    transfer.frames.push_back(frame_of(rest.substr(0, end)));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return transfer;
}

inline const std::vector<RecordedTransfer>& recorded_transfers() {
  static const std::vector<RecordedTransfer> transfers = [] {
    std::ifstream file(IRONBIRD_SOURCE_DIR "/hil_bridge/can/test/transfers.csv");
    std::vector<RecordedTransfer> all;
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) all.push_back(transfer_of(cells_of(line)));
    if (all.size() != 26) throw std::runtime_error("transfers.csv has to have 26 transfers");
    return all;
  }();
  return transfers;
}

}  // namespace ironbird::hil_bridge::can
