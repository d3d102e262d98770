#include "load/gltf_accessors.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "load/gltf_container.h"

namespace ukemi::load {
namespace {

// More elements than any character needs, so that a small file cannot ask for gigabytes of zeros.
constexpr std::int64_t kMaxElements = std::int64_t{1} << 25;

struct ElementType {
  const char* name;
  int columns;
  int rows;
};
constexpr std::array<ElementType, 7> kShapes{{{"SCALAR", 1, 1},
                                              {"VEC2", 1, 2},
                                              {"VEC3", 1, 3},
                                              {"VEC4", 1, 4},
                                              {"MAT2", 2, 2},
                                              {"MAT3", 3, 3},
                                              {"MAT4", 4, 4}}};

const ElementType& shape_named(const JsonView& name) {
  const std::string text = name.text();
  for (const ElementType& shape : kShapes)
    if (text == shape.name) return shape;
  name.refuse(fmt::format("is \"{}\", which is no accessor type", text));
}

ComponentType component_type_of(const JsonView& value) {
  const std::int64_t code = value.integer(0, 1 << 16);
  if (code < 5120 || code > 5126 || code == 5124)
    value.refuse(fmt::format("is {}, which is no component type", code));
  return static_cast<ComponentType>(code);
}

/// Byte offsets of an element's components: columns of matrices start at multiples of four.
std::vector<std::size_t> component_offsets(const ElementType& shape, ComponentType type) {
  const std::size_t column_bytes = static_cast<std::size_t>(shape.rows) * byte_size(type);
  const std::size_t column_stride = shape.columns > 1 ? (column_bytes + 3) / 4 * 4 : column_bytes;
  std::vector<std::size_t> offsets;
  for (int column = 0; column < shape.columns; ++column)
    for (int row = 0; row < shape.rows; ++row)
      offsets.push_back(static_cast<std::size_t>(column) * column_stride +
                        static_cast<std::size_t>(row) * byte_size(type));
  return offsets;
}

std::size_t element_bytes(const std::vector<std::size_t>& offsets, ComponentType type) {
  return offsets.back() + byte_size(type);
}

template <typename Stored, typename Number>
void copy_as(const std::uint8_t* from, std::size_t stride, const std::vector<std::size_t>& component,
             std::size_t count, Number* out) {
  for (std::size_t i = 0; i < count; ++i, from += stride)
    for (const std::size_t offset : component) {
      Stored value;
      std::memcpy(&value, from + offset, sizeof value);
      *out++ = static_cast<Number>(value);
    }
}

}  // namespace

std::size_t byte_size(ComponentType type) {
  switch (type) {
    case ComponentType::int8:
    case ComponentType::uint8:
      return 1;
    case ComponentType::int16:
    case ComponentType::uint16:
      return 2;
    default:
      return 4;
  }
}

double largest(ComponentType type) {
  switch (type) {
    case ComponentType::int8:
      return 127.0;
    case ComponentType::uint8:
      return 255.0;
    case ComponentType::int16:
      return 32767.0;
    case ComponentType::uint16:
      return 65535.0;
    case ComponentType::uint32:
      return 4294967295.0;
    default:
      return 1.0;
  }
}

Accessors::Accessors(const JsonView& root, const std::vector<std::vector<std::uint8_t>>& buffers,
                     MemoryBudget& budget)
    : buffers_(buffers), budget_(budget) {
  for (const JsonView& view : root.items("bufferViews")) read_view(view, buffers);
  for (const JsonView& accessor : root.items("accessors")) read_accessor(accessor);
}

void Accessors::check_view_range(const JsonView& place, int buffer, std::size_t offset,
                                 std::size_t length) const {
  const std::size_t available = buffers_[buffer].size();
  if (offset > available || length > available - offset)
    place.refuse(fmt::format("covers bytes {} to {}, but buffers[{}] has {}", offset, offset + length, buffer,
                             available));
}

void Accessors::read_view(const JsonView& json, const std::vector<std::vector<std::uint8_t>>& buffers) {
  View view;
  view.place = json.place();
  view.buffer = json.at("buffer").index(buffers.size(), "buffers");
  view.offset = static_cast<std::size_t>(json.integer("byteOffset", 0, kMaxBufferBytes, 0));
  view.length = static_cast<std::size_t>(json.at("byteLength").integer(1, kMaxBufferBytes));
  view.stride = static_cast<std::size_t>(json.integer("byteStride", 1, 252, 0));
  const auto extensions = json.find("extensions");
  const auto meshopt = extensions ? extensions->find("EXT_meshopt_compression") : std::nullopt;
  if (meshopt)
    read_compressed_view(*meshopt, view);
  else if (!buffers[view.buffer].empty())  // a buffer without data is refused when it is read
    check_view_range(json, view.buffer, view.offset, view.length);
  views_.push_back(std::move(view));
}

void Accessors::read_compressed_view(const JsonView& extension, View& view) const {
  static constexpr std::array<std::string_view, 3> kModes{"ATTRIBUTES", "TRIANGLES", "INDICES"};
  static constexpr std::array<std::string_view, 4> kFilters{"NONE", "OCTAHEDRAL", "QUATERNION",
                                                            "EXPONENTIAL"};
  const auto choice = [&](const char* key, std::span<const std::string_view> names,
                          const std::string& otherwise) {
    const std::string text = extension.text(key, otherwise);
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end()) extension.refuse(fmt::format("has {} \"{}\", which is not known", key, text));
    return static_cast<int>(found - names.begin());
  };
  view.compressed = true;
  view.buffer = extension.at("buffer").index(buffers_.size(), "buffers");
  view.offset = static_cast<std::size_t>(extension.integer("byteOffset", 0, kMaxBufferBytes, 0));
  view.compressed_length = static_cast<std::size_t>(extension.at("byteLength").integer(1, kMaxBufferBytes));
  view.element_count = static_cast<std::size_t>(extension.at("count").integer(1, kMaxElements));
  view.mode = choice("mode", kModes, "");
  view.filter = choice("filter", kFilters, "NONE");
  const auto stride = static_cast<std::size_t>(extension.at("byteStride").integer(1, 256));
  const bool good_stride = view.mode == 0 ? stride % 4 == 0 : stride == 2 || stride == 4;
  const bool good_filter =
      view.filter == 0 || (view.mode == 0 && (view.filter != 1 || stride == 4 || stride == 8) &&
                           (view.filter != 2 || stride == 8));
  if (!good_stride || !good_filter || (view.mode == 1 && view.element_count % 3 != 0))
    extension.refuse("has a byteStride, filter or count that does not fit its mode");
  if (stride * view.element_count > static_cast<std::size_t>(kMaxBufferBytes) ||
      stride * view.element_count != view.length)
    extension.refuse(fmt::format("decodes to {} bytes, but {} announces {}", stride * view.element_count,
                                 view.place, view.length));
  if (view.mode == 0) view.stride = stride;
  check_view_range(extension, view.buffer, view.offset, view.compressed_length);
}

std::vector<std::uint8_t> Accessors::decompressed(const View& view) const {
  std::vector<std::uint8_t> bytes(view.length);
  const std::size_t stride = view.length / view.element_count;
  const std::uint8_t* from = buffers_[view.buffer].data() + view.offset;
  const int failed =
      view.mode == 0
          ? meshopt_decodeVertexBuffer(bytes.data(), view.element_count, stride, from, view.compressed_length)
      : view.mode == 1
          ? meshopt_decodeIndexBuffer(bytes.data(), view.element_count, stride, from, view.compressed_length)
          : meshopt_decodeIndexSequence(bytes.data(), view.element_count, stride, from,
                                        view.compressed_length);
  if (failed != 0)
    throw Refusal(
        fmt::format("{}: its {} compressed bytes cannot be decoded", view.place, view.compressed_length),
        "export the file again");
  if (view.filter == 1) meshopt_decodeFilterOct(bytes.data(), view.element_count, stride);
  if (view.filter == 2) meshopt_decodeFilterQuat(bytes.data(), view.element_count, stride);
  if (view.filter == 3) meshopt_decodeFilterExp(bytes.data(), view.element_count, stride);
  return bytes;
}

std::span<const std::uint8_t> Accessors::view_bytes(int index) {
  const View& view = views_[index];
  if (!view.compressed && buffers_[view.buffer].empty())
    throw Refusal(fmt::format("{} lies in buffers[{}], which has no data", view.place, view.buffer),
                  "export the file again");
  if (!view.compressed) return std::span(buffers_[view.buffer]).subspan(view.offset, view.length);
  auto found = decompressed_.find(index);
  if (found == decompressed_.end()) {
    budget_.spend(view.length, view.place);
    found = decompressed_.emplace(index, decompressed(view)).first;
  }
  return found->second;
}

Accessors::Layout Accessors::layout_of(const JsonView& place, int view, std::size_t offset, std::size_t count,
                                       std::size_t bytes, bool own_stride) const {
  Layout layout{view, offset, bytes, {}};
  if (own_stride && views_[view].stride > 0) layout.stride = views_[view].stride;
  if (layout.stride < bytes)
    place.refuse(fmt::format("has elements of {} bytes, but {}.byteStride is {}", bytes, views_[view].place,
                             layout.stride));
  const std::size_t needed = count == 0 ? 0 : offset + layout.stride * (count - 1) + bytes;
  if (needed > views_[view].length)
    place.refuse(
        fmt::format("needs {} bytes, but {} has {}", needed, views_[view].place, views_[view].length));
  return layout;
}

void Accessors::read_accessor(const JsonView& json) {
  Accessor accessor;
  accessor.place = json.place();
  accessor.component_type = component_type_of(json.at("componentType"));
  accessor.normalized = json.boolean("normalized", false);
  accessor.count = static_cast<std::size_t>(json.at("count").integer(0, kMaxElements));
  if (accessor.normalized &&
      (accessor.component_type == ComponentType::float32 || accessor.component_type == ComponentType::uint32))
    json.refuse("is normalized, but its component type is not an 8 or 16 bit integer");
  const ElementType& shape = shape_named(json.at("type"));
  accessor.components = shape.columns * shape.rows;
  const auto offsets = component_offsets(shape, accessor.component_type);
  const std::size_t bytes = element_bytes(offsets, accessor.component_type);
  const int view = json.index("bufferView", views_.size(), "bufferViews");
  if (view >= 0) {
    const auto offset = static_cast<std::size_t>(json.integer("byteOffset", 0, kMaxBufferBytes, 0));
    accessor.layout = layout_of(json, view, offset, accessor.count, bytes, true);
  }
  accessor.layout.component = offsets;
  if (const auto sparse = json.find("sparse")) read_sparse(*sparse, accessor);
  accessors_.push_back(std::move(accessor));
}

void Accessors::read_sparse(const JsonView& sparse, Accessor& accessor) {
  accessor.sparse_count = static_cast<std::size_t>(sparse.at("count").integer(1, kMaxElements));
  if (accessor.sparse_count > accessor.count)
    sparse.refuse(fmt::format("has {} elements of {}", accessor.sparse_count, accessor.count));
  const auto part = [&](const char* key, std::size_t bytes) {
    const JsonView json = sparse.at(key);
    const int view = json.at("bufferView").index(views_.size(), "bufferViews");
    const auto offset = static_cast<std::size_t>(json.integer("byteOffset", 0, kMaxBufferBytes, 0));
    return layout_of(json, view, offset, accessor.sparse_count, bytes, false);
  };
  accessor.sparse_index_type = component_type_of(sparse.at("indices").at("componentType"));
  if (accessor.sparse_index_type != ComponentType::uint8 &&
      accessor.sparse_index_type != ComponentType::uint16 &&
      accessor.sparse_index_type != ComponentType::uint32)
    sparse.at("indices").refuse("are not unsigned integers");
  accessor.sparse_indices = part("indices", byte_size(accessor.sparse_index_type));
  accessor.sparse_indices.component = {0};
  accessor.sparse_values = part("values", element_bytes(accessor.layout.component, accessor.component_type));
  accessor.sparse_values.component = accessor.layout.component;
}

template <typename Number>
void Accessors::copy(const Layout& layout, ComponentType type, std::size_t count, Number* out) {
  if (count == 0) return;
  const std::uint8_t* from = view_bytes(layout.view).data() + layout.first;
  switch (type) {
    case ComponentType::int8:
      return copy_as<std::int8_t>(from, layout.stride, layout.component, count, out);
    case ComponentType::uint8:
      return copy_as<std::uint8_t>(from, layout.stride, layout.component, count, out);
    case ComponentType::int16:
      return copy_as<std::int16_t>(from, layout.stride, layout.component, count, out);
    case ComponentType::uint16:
      return copy_as<std::uint16_t>(from, layout.stride, layout.component, count, out);
    case ComponentType::uint32:
      return copy_as<std::uint32_t>(from, layout.stride, layout.component, count, out);
    case ComponentType::float32:
      return copy_as<float>(from, layout.stride, layout.component, count, out);
  }
}

template <typename Number>
std::vector<Number> Accessors::read(const Accessor& accessor, int components) {
  if (accessor.components != components)
    throw Refusal(fmt::format("{}.type has {} components, but {} are needed", accessor.place,
                              accessor.components, components),
                  "export the file again");
  const auto width = static_cast<std::size_t>(components);
  budget_.spend((accessor.count + accessor.sparse_count) * width * sizeof(Number), accessor.place);
  std::vector<Number> numbers(accessor.count * width);
  if (accessor.layout.view >= 0)
    copy(accessor.layout, accessor.component_type, accessor.count, numbers.data());
  if (accessor.sparse_count == 0) return numbers;
  std::vector<std::uint32_t> indices(accessor.sparse_count);
  std::vector<Number> values(accessor.sparse_count * width);
  copy(accessor.sparse_indices, accessor.sparse_index_type, accessor.sparse_count, indices.data());
  copy(accessor.sparse_values, accessor.component_type, accessor.sparse_count, values.data());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] >= accessor.count || (i > 0 && indices[i] <= indices[i - 1]))
      throw Refusal(
          fmt::format("{}.sparse.indices: element {} is {}, which is out of range or not increasing",
                      accessor.place, i, indices[i]),
          "export the file again");
    std::copy_n(values.data() + i * width, width, numbers.data() + indices[i] * width);
  }
  return numbers;
}

std::vector<float> Accessors::floats(int index, int components) {
  const Accessor& accessor = accessors_[index];
  std::vector<float> numbers = read<float>(accessor, components);
  if (accessor.normalized) {
    const auto one = static_cast<float>(largest(accessor.component_type));
    for (float& number : numbers) number = std::max(number / one, -1.0f);
  }
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (!std::isfinite(numbers[i]))
      throw Refusal(fmt::format("{}: element {} is not finite", accessor.place,
                                i / static_cast<std::size_t>(components)),
                    "export the file again");
  return numbers;
}

std::vector<std::uint32_t> Accessors::unsigned_integers(int index, int components) {
  const Accessor& accessor = accessors_[index];
  if (accessor.component_type != ComponentType::uint8 && accessor.component_type != ComponentType::uint16 &&
      accessor.component_type != ComponentType::uint32)
    throw Refusal(fmt::format("{}.componentType is {}, but unsigned integers are needed", accessor.place,
                              static_cast<int>(accessor.component_type)),
                  "export the file again");
  return read<std::uint32_t>(accessor, components);
}

}  // namespace ukemi::load
