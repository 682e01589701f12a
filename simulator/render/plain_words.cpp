#include "simulator/render/plain_words.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>

namespace ironbird::simulator {
namespace {

std::string on_one_line(const std::string& message) {
  std::istringstream words(message);
  std::string line;
  for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
  return line;
}

/// What stands between `before` and `after`, or nothing.
std::string between(const std::string& text, std::string_view before, std::string_view after) {
  const std::size_t begin = text.find(before);
  if (begin == std::string::npos) return "";
  const std::size_t from = begin + before.size();
  return text.substr(from, text.find(after, from) - from);
}

/// "'XML parse error 6: Error=XML_ERROR_PARSING_ELEMENT ErrorID=6 (0x6) Line number=2 '"
std::string words_of_parser(const std::string& message) {
  const std::string missing = between(message, "filename=", " ");
  if (!missing.empty()) return "includes " + missing + ", which is not there";
  std::string kind = between(message, "XML_ERROR_", " ");
  std::replace(kind.begin(), kind.end(), '_', ' ');
  std::transform(kind.begin(), kind.end(), kind.begin(), [](unsigned char c) { return std::tolower(c); });
  const std::string line = between(message, "Line number=", " ");
  return "is no well-formed XML: " + kind + (line == "0" || line.empty() ? "" : " in line " + line);
}

/// Cuts the engine's note of the object from the end, and keeps its name when the message does not say it.
void shorten_object(std::string& message) {
  constexpr std::string_view kNote = " Object name = ";
  const std::size_t note = message.find(kNote);
  if (note == std::string::npos) return;
  const std::string name = between(message, kNote, ",");
  message.erase(note);
  if (!name.empty() && message.find("'" + name + "'") == std::string::npos) message += ", in '" + name + "'";
}

void shorten_element(std::string& message) {
  const std::size_t element = message.find(" Element '");
  if (element == std::string::npos) return;
  const std::string name = between(message, " Element '", "'");
  message.erase(element);
  if (name != "include") message += " in an element '" + name + "'";
}

}  // namespace

std::string plain_words(const std::string& message) {
  std::string words = on_one_line(message);
  for (const std::string_view lead : {"XML Error: ", "Error: ", "Include error: ", "Schema violation: "}) {
    if (words.starts_with(lead)) words.erase(0, lead.size());
  }
  if (words.find("XML_ERROR_") != std::string::npos) return words_of_parser(words);
  shorten_object(words);
  shorten_element(words);
  return words;
}

}  // namespace ironbird::simulator
