// Buffer views and accessors of a glTF document, bounds-checked.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "load/json_view.h"
#include "load/memory_budget.h"

namespace ukemi::load {

/// glTF component types (glTF 2.0, section 5.1.3).
enum class ComponentType {
  int8 = 5120,
  uint8 = 5121,
  int16 = 5122,
  uint16 = 5123,
  uint32 = 5125,
  float32 = 5126
};
std::size_t byte_size(ComponentType type);
/// The largest integer of the type: what a normalised 1.0 is stored as.
double largest(ComponentType type);

/// Reads numbers out of a document's buffers. All structure (views, offsets, strides, lengths) is checked
/// when it is made, values when they are read. Throws Refusal.
class Accessors {
 public:
  /// `buffers` and `budget`, which pays for all that is read, must outlive this.
  Accessors(const JsonView& root, const std::vector<std::vector<std::uint8_t>>& buffers,
            MemoryBudget& budget);

  std::size_t size() const { return accessors_.size(); }
  std::size_t view_count() const { return views_.size(); }
  std::size_t count(int accessor) const { return accessors_[accessor].count; }
  ComponentType component_type(int accessor) const { return accessors_[accessor].component_type; }
  bool normalized(int accessor) const { return accessors_[accessor].normalized; }
  int components(int accessor) const { return accessors_[accessor].components; }
  const std::string& place(int accessor) const { return accessors_[accessor].place; }

  /// Every component as a finite float, normalised integers as the fractions they stand for. Refuses another
  /// number of components per element than `components`.
  std::vector<float> floats(int accessor, int components);
  /// Every component of an accessor of unsigned integers.
  std::vector<std::uint32_t> unsigned_integers(int accessor, int components);
  /// Content of a buffer view, decompressed.
  std::span<const std::uint8_t> view_bytes(int view);
  MemoryBudget& budget() { return budget_; }

 private:
  struct View {
    std::string place;
    int buffer = -1;
    std::size_t offset = 0;
    std::size_t length = 0;  // decompressed
    std::size_t stride = 0;  // 0: tightly packed
    bool compressed = false;
    int mode = 0;    // compressed: 0 attributes, 1 triangles, 2 indices
    int filter = 0;  // compressed: 0 none, 1 octahedral, 2 quaternion, 3 exponential
    std::size_t compressed_length = 0;
    std::size_t element_count = 0;
  };
  struct Layout {  // where the components of element i lie: first + i * stride + component[k]
    int view = -1;
    std::size_t first = 0;
    std::size_t stride = 0;
    std::vector<std::size_t> component;
  };
  struct Accessor {
    std::string place;
    ComponentType component_type = ComponentType::float32;
    int components = 1;
    bool normalized = false;
    std::size_t count = 0;
    Layout layout;
    std::size_t sparse_count = 0;
    ComponentType sparse_index_type = ComponentType::uint16;
    Layout sparse_indices;
    Layout sparse_values;
  };

  void read_view(const JsonView& view, const std::vector<std::vector<std::uint8_t>>& buffers);
  void read_compressed_view(const JsonView& extension, View& view) const;
  void check_view_range(const JsonView& place, int buffer, std::size_t offset, std::size_t length) const;
  void read_accessor(const JsonView& accessor);
  void read_sparse(const JsonView& sparse, Accessor& accessor);
  Layout layout_of(const JsonView& place, int view, std::size_t offset, std::size_t count,
                   std::size_t element_bytes, bool own_stride) const;
  std::vector<std::uint8_t> decompressed(const View& view) const;
  template <typename Number>
  void copy(const Layout& layout, ComponentType type, std::size_t count, Number* out);
  template <typename Number>
  std::vector<Number> read(const Accessor& accessor, int components);

  const std::vector<std::vector<std::uint8_t>>& buffers_;
  MemoryBudget& budget_;
  std::vector<View> views_;
  std::vector<Accessor> accessors_;
  std::map<int, std::vector<std::uint8_t>> decompressed_;
};

}  // namespace ukemi::load
