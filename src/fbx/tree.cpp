// Layout of the file, after the readers of Blender and assimp (Autodesk publishes none): 27 bytes of header
// with the version; records, each: end offset, number and length of its properties (32 bits each, 64 from 7.5
// on), length of the name (8 bits), name, properties, records inside; an empty record ends a list; a tail.
#include "fbx/tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "base/errors.h"
#include "fbx/deflate.h"

namespace ukemi {
namespace {

using Bytes = std::vector<std::uint8_t>;
using View = std::span<const std::uint8_t>;

constexpr std::string_view kMagic{"Kaydara FBX Binary  \0\x1A\0", 23};
constexpr std::size_t kHeaderBytes = 27;
constexpr std::uint32_t kOldest = 7000;
constexpr std::uint32_t kWide = 7500;           // offsets of 64 bits
constexpr std::uint32_t kNewest = 8000;         // nobody has seen one
constexpr std::size_t kMostRecords = 8u << 20;  // 1 GB
constexpr int kDeepest = 64;
constexpr const char* kExportAgain = "export it again as a binary FBX 7.4";

struct Malformed {
  std::string what;
  std::size_t offset = 0;
};

template <typename Number>
Number number_from(View bytes) {
  Number number{};
  std::memcpy(&number, bytes.data(), sizeof(Number));
  return number;
}

template <typename Number>
void put(Bytes& bytes, Number number) {
  for (const std::uint8_t byte : std::bit_cast<std::array<std::uint8_t, sizeof(Number)>>(number))
    bytes.push_back(byte);
}

/// Size of a number of that type; 0 where the type is no number.
std::size_t scalar_bytes(char type) {
  switch (type) {
    case 'C':
    case 'B':
      return 1;
    case 'Y':
      return 2;
    case 'I':
    case 'F':
      return 4;
    case 'D':
    case 'L':
      return 8;
    default:
      return 0;
  }
}

std::size_t element_bytes(char type) {
  switch (type) {
    case 'b':
    case 'c':
      return 1;
    case 'i':
    case 'f':
      return 4;
    case 'd':
    case 'l':
      return 8;
    default:
      return 0;
  }
}

/// Walks the records; throws Malformed.
class TreeReader {
 public:
  TreeReader(View bytes, std::uint32_t version) : bytes_(bytes), wide_(version >= kWide) {}

  FbxTree read() {
    FbxTree tree;
    at_ = kHeaderBytes;
    while (auto record = next(bytes_.size(), 0)) tree.records.push_back(std::move(*record));
    tree.tail.assign(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), bytes_.end());
    return tree;
  }

 private:
  struct Head {
    std::uint64_t end = 0;
    std::uint64_t properties = 0;
    std::uint64_t property_bytes = 0;
    std::string name;
  };

  [[noreturn]] void fail(std::string what) const { throw Malformed{std::move(what), at_}; }

  View take(std::uint64_t count, std::size_t end) {
    if (count > end - at_) fail("ends in the middle of a record");
    const View taken = bytes_.subspan(at_, static_cast<std::size_t>(count));
    at_ += static_cast<std::size_t>(count);
    return taken;
  }
  template <typename Number>
  Number number(std::size_t end) {
    return number_from<Number>(take(sizeof(Number), end));
  }
  std::uint64_t offset(std::size_t end) {
    return wide_ ? number<std::uint64_t>(end) : number<std::uint32_t>(end);
  }

  Head head(std::size_t end) {
    Head head;
    head.end = offset(end);
    head.properties = offset(end);
    head.property_bytes = offset(end);
    const View name = take(number<std::uint8_t>(end), end);
    head.name.assign(name.begin(), name.end());
    return head;
  }

  /// The record at the cursor; nothing for the empty one that ends a list.
  std::optional<FbxRecord> next(std::size_t end, int depth) {
    const std::size_t start = at_;
    Head head = this->head(end);
    if (head.end == 0) {
      if (head.properties != 0 || head.property_bytes != 0 || !head.name.empty()) fail("has a record at 0");
      return std::nullopt;
    }
    if (++records_ > kMostRecords) fail(fmt::format("has more than {} records", kMostRecords));
    if (depth > kDeepest) fail(fmt::format("nests records more than {} deep", kDeepest));
    if (head.end > end || head.end < at_ || head.property_bytes > head.end - at_) {
      at_ = start;
      fail("has a record that ends outside of what holds it");
    }
    FbxRecord record;
    record.name = std::move(head.name);
    read_properties(head, record);
    read_children(static_cast<std::size_t>(head.end), depth, record);
    return record;
  }

  void read_properties(const Head& head, FbxRecord& record) {
    const std::size_t end = at_ + static_cast<std::size_t>(head.property_bytes);
    if (head.properties > head.property_bytes) fail("counts more properties than it has bytes for");
    record.properties.reserve(static_cast<std::size_t>(head.properties));
    for (std::uint64_t i = 0; i < head.properties; ++i) record.properties.push_back(property(end));
    if (at_ != end) fail("has properties of another length than it says");
  }

  FbxProperty property(std::size_t end) {
    const char type = static_cast<char>(number<std::uint8_t>(end));
    const View bytes = take(property_bytes(type, end), end);
    return {type, Bytes(bytes.begin(), bytes.end())};
  }

  /// Bytes of the property at the cursor, without the letter of its type.
  std::uint64_t property_bytes(char type, std::size_t end) {
    if (const std::size_t scalar = scalar_bytes(type); scalar > 0) return scalar;
    if (type == 'S' || type == 'R') return 4 + std::uint64_t{peek(0, end)};
    const std::uint64_t element = element_bytes(type);
    if (element == 0) fail("has a property of an unknown type");
    const std::uint64_t count = peek(0, end);
    const std::uint32_t encoding = peek(4, end);
    const std::uint64_t stored = peek(8, end);
    if (encoding > 1) fail("has an array in an unknown encoding");
    if (encoding == 0 && stored != count * element) fail("has an array of another length than it says");
    return 12 + stored;
  }
  std::uint32_t peek(std::size_t ahead, std::size_t end) const {
    if (end - at_ < ahead + 4) fail("ends in the middle of a record");
    return number_from<std::uint32_t>(bytes_.subspan(at_ + ahead));
  }

  void read_children(std::size_t end, int depth, FbxRecord& record) {
    while (at_ < end) {
      auto child = next(end, depth + 1);
      if (!child) {
        record.is_closed = true;
        if (at_ != end) fail("has content behind the end of a list");
        return;
      }
      record.children.push_back(std::move(*child));
    }
  }

  View bytes_;
  bool wide_;
  std::size_t at_ = 0;
  std::size_t records_ = 0;
};

class TreeWriter {
 public:
  explicit TreeWriter(std::uint32_t version) : wide_(version >= kWide) {
    bytes_.assign(kMagic.begin(), kMagic.end());
    put(bytes_, version);
  }

  void write(const FbxRecord& record) {
    const std::size_t start = bytes_.size();
    put_offset(0), put_offset(record.properties.size()), put_offset(0);
    put(bytes_, static_cast<std::uint8_t>(record.name.size()));
    bytes_.insert(bytes_.end(), record.name.begin(), record.name.end());
    const std::size_t properties = bytes_.size();
    for (const FbxProperty& property : record.properties) {
      bytes_.push_back(static_cast<std::uint8_t>(property.type));
      bytes_.insert(bytes_.end(), property.bytes.begin(), property.bytes.end());
    }
    set_offset(start + 2 * offset_bytes(), bytes_.size() - properties);
    for (const FbxRecord& child : record.children) write(child);
    if (record.is_closed) end_list();
    set_offset(start, bytes_.size());
  }

  void end_list() { bytes_.resize(bytes_.size() + 3 * offset_bytes() + 1); }

  Bytes finish(const Bytes& tail) {
    end_list();
    bytes_.insert(bytes_.end(), tail.begin(), tail.end());
    return std::move(bytes_);
  }
  std::size_t size() const { return bytes_.size(); }

 private:
  std::size_t offset_bytes() const { return wide_ ? 8 : 4; }
  void put_offset(std::uint64_t offset) {
    if (wide_)
      put(bytes_, offset);
    else
      put(bytes_, static_cast<std::uint32_t>(offset));
  }
  void set_offset(std::size_t where, std::uint64_t offset) {
    std::memcpy(bytes_.data() + where, &offset, offset_bytes());  // little-endian
  }

  Bytes bytes_;
  bool wide_;
};

constexpr std::size_t kCodeBytes = 16;
constexpr std::size_t kEndBytes = 4 + 120 + 16;

/// The end: a code of 16 bytes, zeros, the version, 120 zeros, a mark of 16 bytes. The zeros before the
/// version align it; there are at least four, and 20 where four would do.
Bytes padded_tail(const FbxTree& tree, std::size_t records_end) {
  const Bytes& tail = tree.tail;
  if (tail.size() < kCodeBytes + kEndBytes) return tail;
  const auto end = tail.end() - static_cast<std::ptrdiff_t>(kEndBytes);
  if (std::any_of(tail.begin() + kCodeBytes, end, [](std::uint8_t b) { return b != 0; })) return tail;
  constexpr std::size_t kFewest = 5;
  const std::size_t first = records_end + kCodeBytes + kFewest;
  Bytes padded(tail.begin(), tail.begin() + kCodeBytes);
  padded.resize(kCodeBytes + kFewest + (16 + tree.end_alignment - first % 16) % 16);
  padded.insert(padded.end(), end, tail.end());
  return padded;
}

template <typename Number>
FbxProperty scalar(char type, Number value) {
  FbxProperty property{type, {}};
  put(property.bytes, value);
  return property;
}

template <typename Number>
FbxProperty array_of(char type, const std::vector<Number>& values) {
  const View raw(reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(Number));
  const Bytes small = raw.size() > 64 ? deflated(raw) : Bytes{};
  const bool deflates = !small.empty() && small.size() < raw.size();
  const View stored = deflates ? View(small) : raw;
  FbxProperty property{type, {}};
  put(property.bytes, static_cast<std::uint32_t>(values.size()));
  put(property.bytes, std::uint32_t{deflates ? 1u : 0u});
  put(property.bytes, static_cast<std::uint32_t>(stored.size()));
  property.bytes.insert(property.bytes.end(), stored.begin(), stored.end());
  return property;
}

double element_at(char type, View bytes) {
  switch (type) {
    case 'd':
      return number_from<double>(bytes);
    case 'f':
      return static_cast<double>(number_from<float>(bytes));
    case 'l':
      return static_cast<double>(number_from<std::int64_t>(bytes));
    case 'i':
      return number_from<std::int32_t>(bytes);
    default:
      return number_from<std::int8_t>(bytes);
  }
}

}  // namespace

Result<FbxTree> read_fbx_tree(std::span<const std::uint8_t> bytes, const std::filesystem::path& path) try {
  const bool binary = bytes.size() >= kHeaderBytes &&
                      std::equal(kMagic.begin(), kMagic.end(), bytes.begin(),
                                 [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
  if (!binary) return input_error(path, "is no binary FBX, so no take can be added to it", kExportAgain);
  const auto version = number_from<std::uint32_t>(bytes.subspan(kMagic.size()));
  if (version < kOldest || version >= kNewest)
    return input_error(path,
                       fmt::format("is an FBX of version {}.{}; takes are added to 7.0 and later",
                                   version / 1000, version / 100 % 10),
                       kExportAgain);
  FbxTree tree = TreeReader(bytes, version).read();
  tree.version = version;
  if (bytes.size() >= kEndBytes) tree.end_alignment = (bytes.size() - kEndBytes) % 16;
  return tree;
} catch (const Malformed& malformed) {
  return input_error(path, fmt::format("is a broken FBX: {} (byte {})", malformed.what, malformed.offset),
                     kExportAgain);
}

Result<std::vector<std::uint8_t>> write_fbx_tree(const FbxTree& tree, const std::filesystem::path& path) {
  TreeWriter writer(tree.version);
  for (const FbxRecord& record : tree.records) writer.write(record);
  const std::size_t empty_record = tree.version >= kWide ? 25 : 13;
  const std::size_t records_end = writer.size() + empty_record;
  Bytes bytes = writer.finish(padded_tail(tree, records_end));
  if (tree.version < kWide && bytes.size() > std::numeric_limits<std::uint32_t>::max())
    return output_error(path, "is too large for an FBX 7.4", "write a .glb instead");
  return bytes;
}

const FbxRecord* child_of(const FbxRecord& record, std::string_view name) {
  for (const FbxRecord& child : record.children)
    if (child.name == name) return &child;
  return nullptr;
}
FbxRecord* child_of(FbxRecord& record, std::string_view name) {
  return const_cast<FbxRecord*>(child_of(std::as_const(record), name));
}

std::optional<std::string_view> text_at(const FbxRecord& record, std::size_t i) {
  if (i >= record.properties.size()) return std::nullopt;
  const FbxProperty& property = record.properties[i];
  if ((property.type != 'S' && property.type != 'R') || property.bytes.size() < 4) return std::nullopt;
  return std::string_view(reinterpret_cast<const char*>(property.bytes.data()) + 4,
                          property.bytes.size() - 4);
}

std::optional<std::int64_t> integer_at(const FbxRecord& record, std::size_t i) {
  if (i >= record.properties.size()) return std::nullopt;
  const FbxProperty& property = record.properties[i];
  if (property.bytes.size() != scalar_bytes(property.type)) return std::nullopt;
  switch (property.type) {
    case 'C':
    case 'B':
      return number_from<std::int8_t>(property.bytes);
    case 'Y':
      return number_from<std::int16_t>(property.bytes);
    case 'I':
      return number_from<std::int32_t>(property.bytes);
    case 'L':
      return number_from<std::int64_t>(property.bytes);
    default:
      return std::nullopt;
  }
}

std::optional<double> number_at(const FbxRecord& record, std::size_t i) {
  if (const auto integer = integer_at(record, i)) return static_cast<double>(*integer);
  if (i >= record.properties.size()) return std::nullopt;
  const FbxProperty& property = record.properties[i];
  if (property.type == 'D' && property.bytes.size() == 8) return number_from<double>(property.bytes);
  if (property.type == 'F' && property.bytes.size() == 4)
    return static_cast<double>(number_from<float>(property.bytes));
  return std::nullopt;
}

std::optional<std::vector<double>> numbers_at(const FbxRecord& record, std::size_t i) {
  if (i >= record.properties.size()) return std::nullopt;
  const FbxProperty& property = record.properties[i];
  const std::size_t element = element_bytes(property.type);
  const View bytes = property.bytes;
  if (element == 0 || bytes.size() < 12) return std::nullopt;
  const std::size_t size = element * std::size_t{number_from<std::uint32_t>(bytes)};
  const bool deflates = number_from<std::uint32_t>(bytes.subspan(4)) == 1;
  Bytes inflated;
  if (deflates) {
    auto content = ukemi::inflated(bytes.subspan(12), size);
    if (!content) return std::nullopt;
    inflated = std::move(*content);
  }
  const View raw = deflates ? View(inflated) : bytes.subspan(12);
  if (raw.size() != size) return std::nullopt;
  std::vector<double> numbers;
  for (std::size_t k = 0; k < size; k += element)
    numbers.push_back(element_at(property.type, raw.subspan(k, element)));
  return numbers;
}

FbxProperty fbx_text(std::string_view text) {
  return {'S', fbx_bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}).bytes};
}
FbxProperty fbx_bytes(std::span<const std::uint8_t> bytes) {
  FbxProperty property{'R', {}};
  put(property.bytes, static_cast<std::uint32_t>(bytes.size()));
  property.bytes.insert(property.bytes.end(), bytes.begin(), bytes.end());
  return property;
}
FbxProperty fbx_int(std::int32_t value) { return scalar('I', value); }
FbxProperty fbx_long(std::int64_t value) { return scalar('L', value); }
FbxProperty fbx_double(double value) { return scalar('D', value); }
FbxProperty fbx_array(const std::vector<double>& values) { return array_of('d', values); }
FbxProperty fbx_array(const std::vector<float>& values) { return array_of('f', values); }
FbxProperty fbx_array(const std::vector<std::int32_t>& values) { return array_of('i', values); }
FbxProperty fbx_array(const std::vector<std::int64_t>& values) { return array_of('l', values); }

FbxRecord fbx_leaf(std::string name, std::vector<FbxProperty> properties) {
  return {std::move(name), std::move(properties), {}, false};
}
FbxRecord fbx_branch(std::string name, std::vector<FbxProperty> properties, std::vector<FbxRecord> children) {
  return {std::move(name), std::move(properties), std::move(children), true};
}

}  // namespace ukemi
