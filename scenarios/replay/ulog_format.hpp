#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ironbird::scenarios {

/// What a record of a ULog file is made of in the end. Little endian.
enum class UlogType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat,
  kDouble,
  kBool,
  kChar
};

constexpr std::array<std::pair<UlogType, std::string_view>, 12> enumerators(UlogType) {
  return {{{UlogType::kInt8, "int8_t"},
           {UlogType::kUint8, "uint8_t"},
           {UlogType::kInt16, "int16_t"},
           {UlogType::kUint16, "uint16_t"},
           {UlogType::kInt32, "int32_t"},
           {UlogType::kUint32, "uint32_t"},
           {UlogType::kInt64, "int64_t"},
           {UlogType::kUint64, "uint64_t"},
           {UlogType::kFloat, "float"},
           {UlogType::kDouble, "double"},
           {UlogType::kBool, "bool"},
           {UlogType::kChar, "char"}}};
}

/// Bytes of one value.
std::size_t size_of(UlogType type);

/// One field as a format message tells it: `float[3] gyro_rad`.
struct UlogFormatField {
  std::string type;  ///< a UlogType, or another format
  std::string name;
  std::size_t count = 1;  ///< elements of an array; 1 without brackets
  bool is_array = false;
};

/// A format message: `sensor_combined:uint64_t timestamp;float[3] gyro_rad;...`.
struct UlogFormat {
  std::string name;
  std::vector<UlogFormatField> fields;
};

/// Takes a format message apart. @return nothing when it is none
std::optional<UlogFormat> parse_ulog_format(std::string_view text);

/// One field as text, `type name` or `type[N] name`, as keys of information and parameters are written too.
/// @return nothing when it is none
std::optional<UlogFormatField> parse_ulog_field(std::string_view text);

/// Where the fields of a record lie: a format whose types are resolved. Records are packed.
struct UlogLayout {
  struct Field {
    std::string name;
    UlogType type = UlogType::kChar;     ///< of a field that is not nested
    const UlogLayout* nested = nullptr;  ///< of one that is; lives as long as the UlogLayouts
    std::size_t count = 1;
    std::size_t offset = 0;  ///< of its first element, bytes
    bool is_array = false;

    bool is_padding() const { return name.starts_with("_padding"); }
    /// Of one element, bytes.
    std::size_t stride() const { return nested != nullptr ? nested->size : size_of(type); }
  };

  std::string name;
  std::vector<Field> fields;
  std::size_t size = 0;         ///< bytes, inside another layout
  std::size_t record_size = 0;  ///< bytes, as a record: padding at the very end is not written

  /// May a record have this many bytes?
  bool takes(std::size_t bytes) const { return bytes == size || bytes == record_size; }
  const Field* find(std::string_view field) const;
};

/// Resolves formats, each once.
class UlogLayouts {
 public:
  /// The first format of a name counts.
  void add(UlogFormat format);
  bool has(std::string_view name) const { return formats_.contains(name); }

  /// The layout of a format. @return null: there is none, it has no fields, names a type that is none,
  /// goes round in a circle, or is longer than a message can be. What was not found is not
  /// sought anew before look_again: looking costs as much as the formats are long
  const UlogLayout* find(std::string_view name);
  /// More formats have come.
  void look_again();

 private:
  static constexpr std::size_t kLongest = 65535;  // bytes: what the size of a message can say
  static constexpr int kDeepest = 16;             // formats in formats

  const UlogLayout* resolve(std::string_view name, int depth);
  std::optional<UlogLayout> laid_out(const UlogFormat& format, int depth);

  std::map<std::string, UlogFormat, std::less<>> formats_;
  std::map<std::string, UlogLayout, std::less<>> layouts_;
  std::set<std::string, std::less<>> without_;  // a layout, with the formats that there are
};

}  // namespace ironbird::scenarios
