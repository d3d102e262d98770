#include "load/gltf_accessors.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <limits>

#include "gltf_builder.h"

namespace ukemi::load {
namespace {

using test::Bytes;
using test::Document;
using test::Json;

/// Accessors of a document whose only buffer is its binary part.
class Loaded {
 public:
  explicit Loaded(const Document& d)
      : document_(d.json.dump()), buffers_{d.binary}, accessors(document_.root(), buffers_, budget_) {}

 private:
  JsonDocument document_;
  std::vector<Bytes> buffers_;
  MemoryBudget budget_;

 public:
  Accessors accessors;
};

std::string refusal(const Document& d) {
  try {
    Loaded loaded(d);
    for (std::size_t i = 0; i < loaded.accessors.size(); ++i)
      loaded.accessors.floats(static_cast<int>(i), loaded.accessors.components(static_cast<int>(i)));
  } catch (const Refusal& r) {
    return r.message;
  }
  return "";
}

struct Layout {
  std::size_t stride;  // 0: packed
  std::size_t offset;
};

/// Element i, component k of type Number is low + (7 * (3 * i + k)) of its range; read back as float.
template <typename Number>
void check_type(int code, bool normalized) {
  for (const Layout layout : {Layout{0, 0}, Layout{0, 8}, Layout{24, 0}, Layout{24, 4}, Layout{252, 12}}) {
    SCOPED_TRACE(fmt::format("type {} normalized {} stride {} offset {}", code, normalized, layout.stride,
                             layout.offset));
    constexpr std::size_t kCount = 11;
    const std::size_t step = layout.stride > 0 ? layout.stride : 3 * sizeof(Number);
    Bytes bytes(layout.offset + step * (kCount - 1) + 3 * sizeof(Number), 0xAB);
    std::vector<Number> stored;
    for (std::size_t i = 0; i < kCount; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double u = static_cast<double>((7 * (3 * i + k)) % 31) / 30.0;
        const double low = static_cast<double>(std::numeric_limits<Number>::lowest());
        const double high = static_cast<double>(std::numeric_limits<Number>::max());
        stored.push_back(code == 5126 ? static_cast<Number>(u * 100.0 - 50.0)
                                      : static_cast<Number>(std::floor(low + u * (high - low))));
        std::memcpy(bytes.data() + layout.offset + i * step + k * sizeof(Number), &stored.back(),
                    sizeof(Number));
      }
    Document d;
    const int view = d.view(bytes.data(), bytes.size(), static_cast<int>(layout.stride));
    d.accessor({{"bufferView", view},
                {"byteOffset", layout.offset},
                {"componentType", code},
                {"count", kCount},
                {"type", "VEC3"},
                {"normalized", normalized}});
    Loaded loaded(d);
    const std::vector<float> read = loaded.accessors.floats(0, 3);
    ASSERT_EQ(read.size(), stored.size());
    for (std::size_t i = 0; i < stored.size(); ++i) {
      const double value = static_cast<double>(stored[i]);
      const double top = static_cast<double>(std::numeric_limits<Number>::max());
      const double expected = normalized ? std::max(value / top, -1.0) : value;
      ASSERT_NEAR(static_cast<double>(read[i]), expected, 1e-6 * std::max(1.0, std::abs(expected))) << i;
    }
  }
}

TEST(Accessors, ReadEveryComponentTypePackedAndInterleaved) {
  for (const bool normalized : {false, true}) {
    check_type<std::int8_t>(5120, normalized);
    check_type<std::uint8_t>(5121, normalized);
    check_type<std::int16_t>(5122, normalized);
    check_type<std::uint16_t>(5123, normalized);
  }
  check_type<std::uint32_t>(5125, false);
  check_type<float>(5126, false);
}

TEST(Accessors, NormalisedEndsAreExact) {
  Document d;
  d.add<std::uint8_t>({0, 255}, 5121, "SCALAR", 1, true);
  d.add<std::int8_t>({-128, -127, 127}, 5120, "SCALAR", 1, true);
  d.add<std::int16_t>({-32768, 0, 32767}, 5122, "SCALAR", 1, true);
  Loaded loaded(d);
  EXPECT_EQ(loaded.accessors.floats(0, 1), (std::vector<float>{0, 1}));
  EXPECT_EQ(loaded.accessors.floats(1, 1), (std::vector<float>{-1, -1, 1}));
  EXPECT_EQ(loaded.accessors.floats(2, 1), (std::vector<float>{-1, 0, 1}));
}

TEST(Accessors, MatrixColumnsOfSmallTypesStartAtMultiplesOfFour) {
  Document d;
  const Bytes bytes{1, 2, 0, 0, 3, 4, 0, 0};
  const int view = d.view(bytes.data(), bytes.size());
  d.accessor({{"bufferView", view}, {"componentType", 5121}, {"count", 1}, {"type", "MAT2"}});
  Loaded loaded(d);
  EXPECT_EQ(loaded.accessors.floats(0, 4), (std::vector<float>{1, 2, 3, 4}));
}

TEST(Accessors, SparseReplacesElementsOfZerosAndOfAView) {
  for (const int index_type : {5121, 5123, 5125}) {
    Document d;
    const std::vector<float> base{0, 1, 2, 3, 4};
    const std::vector<float> values{10, 30};
    const int base_view = d.view(base.data(), 20);
    const int value_view = d.view(values.data(), 8);
    Bytes indices;
    const std::size_t width = index_type == 5121 ? 1 : index_type == 5123 ? 2 : 4;
    for (const std::uint8_t index : Bytes{1, 3})
      for (std::size_t k = 0; k < width; ++k) indices.push_back(k == 0 ? index : std::uint8_t{0});
    const int index_view = d.view(indices.data(), indices.size());
    Json fields{{"componentType", 5126}, {"count", 5}, {"type", "SCALAR"}};
    fields["sparse"] = {{"count", 2},
                        {"indices", {{"bufferView", index_view}, {"componentType", index_type}}},
                        {"values", {{"bufferView", value_view}}}};
    d.accessor(fields);
    fields["bufferView"] = base_view;
    d.accessor(fields);
    Loaded loaded(d);
    EXPECT_EQ(loaded.accessors.floats(0, 1), (std::vector<float>{0, 10, 0, 30, 0}));
    EXPECT_EQ(loaded.accessors.floats(1, 1), (std::vector<float>{0, 10, 2, 30, 4}));
  }
}

TEST(Accessors, RefuseWithTheirPlaceAndSizes) {
  const auto with = [](const Json& changes) {
    Document d;
    d.floats({1, 2, 3, 4, 5, 6}, "VEC3", 3);
    d.json.merge_patch(changes);
    return d;
  };
  const auto first_accessor = [&](const Json& patch) {
    Document d = with(Json::object());
    d.json["accessors"][0].merge_patch(patch);
    return refusal(d);
  };
  const auto first_view = [&](const Json& patch) {
    Document d = with(Json::object());
    d.json["bufferViews"][0].merge_patch(patch);
    d.json["buffers"] = {{{"byteLength", 24}}};
    return refusal(d);
  };
  EXPECT_EQ(first_accessor(Json::object()), "");
  EXPECT_EQ(first_accessor({{"count", 3}}), "accessors[0] needs 36 bytes, but bufferViews[0] has 24");
  EXPECT_EQ(first_accessor({{"count", -1}}), "accessors[0].count is -1, outside 0 to 33554432");
  EXPECT_EQ(first_accessor({{"count", 1e300}}), "accessors[0].count is 1e+300, outside 0 to 33554432");
  EXPECT_EQ(first_accessor({{"count", 1.5}}), "accessors[0].count is 1.5, not a whole number");
  EXPECT_EQ(first_accessor({{"count", "2"}}), "accessors[0].count is not a number");
  EXPECT_EQ(first_accessor({{"count", nullptr}}), "accessors[0] has no \"count\"");
  EXPECT_EQ(first_accessor({{"byteOffset", 4}}), "accessors[0] needs 28 bytes, but bufferViews[0] has 24");
  EXPECT_EQ(first_accessor({{"byteOffset", -4}}), "accessors[0].byteOffset is -4, outside 0 to 1073741824");
  EXPECT_EQ(first_accessor({{"componentType", 5124}}),
            "accessors[0].componentType is 5124, which is no component type");
  EXPECT_EQ(first_accessor({{"type", "VEC5"}}), "accessors[0].type is \"VEC5\", which is no accessor type");
  EXPECT_EQ(first_accessor({{"bufferView", 1}}), "accessors[0].bufferView is 1, but there are 1 bufferViews");
  EXPECT_EQ(first_accessor({{"normalized", true}}).substr(0, 26), "accessors[0] is normalized");
  EXPECT_EQ(first_view({{"byteLength", 25}}), "bufferViews[0] covers bytes 0 to 25, but buffers[0] has 24");
  EXPECT_EQ(first_view({{"byteOffset", 8}}), "bufferViews[0] covers bytes 8 to 32, but buffers[0] has 24");
  EXPECT_EQ(first_view({{"buffer", 2}}), "bufferViews[0].buffer is 2, but there are 1 buffers");
  EXPECT_EQ(first_view({{"byteStride", 8}}),
            "accessors[0] has elements of 12 bytes, but bufferViews[0].byteStride is 8");
  Document not_finite;
  not_finite.floats({1, 2, std::numeric_limits<float>::infinity()}, "SCALAR", 1);
  EXPECT_EQ(refusal(not_finite), "accessors[0]: element 2 is not finite");
}

TEST(Accessors, SparseRefusesIndicesOutOfRangeOrNotIncreasing) {
  for (const auto& [first, second] : {std::pair{1, 5}, {3, 1}, {2, 2}}) {
    Document d;
    const std::vector<float> values{10, 30};
    const Bytes indices{static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(second)};
    const int value_view = d.view(values.data(), 8);
    const int index_view = d.view(indices.data(), indices.size());
    d.accessor({{"componentType", 5126},
                {"count", 5},
                {"type", "SCALAR"},
                {"sparse",
                 {{"count", 2},
                  {"indices", {{"bufferView", index_view}, {"componentType", 5121}}},
                  {"values", {{"bufferView", value_view}}}}}});
    EXPECT_NE(refusal(d).find("accessors[0].sparse.indices: element 1"), std::string::npos)
        << first << second;
  }
}

Document meshopt_document(const std::vector<float>& numbers) {
  Bytes encoded(meshopt_encodeVertexBufferBound(numbers.size() / 3, 12));
  encoded.resize(
      meshopt_encodeVertexBuffer(encoded.data(), encoded.size(), numbers.data(), numbers.size() / 3, 12));
  Document d;
  d.view(encoded.data(), encoded.size());
  d.json["bufferViews"][0] = {{"buffer", 0},
                              {"byteLength", numbers.size() * 4},
                              {"extensions",
                               {{"EXT_meshopt_compression",
                                 {{"buffer", 0},
                                  {"byteLength", encoded.size()},
                                  {"byteStride", 12},
                                  {"count", numbers.size() / 3},
                                  {"mode", "ATTRIBUTES"}}}}}};
  d.accessor({{"bufferView", 0}, {"componentType", 5126}, {"count", numbers.size() / 3}, {"type", "VEC3"}});
  return d;
}

TEST(Accessors, PayForWhatTheyRead) {
  Document d;
  d.accessor({{"componentType", 5126}, {"count", 1000}, {"type", "VEC3"}});
  const JsonDocument document(d.json.dump());
  const std::vector<Bytes> buffers;
  MemoryBudget budget;
  budget.spend((std::size_t{4} << 30) - 2 * 12000, "the rest");
  Accessors accessors(document.root(), buffers, budget);
  accessors.floats(0, 3);
  accessors.floats(0, 3);
  try {
    accessors.floats(0, 3);
    FAIL() << "more than the budget";
  } catch (const Refusal& r) {
    EXPECT_EQ(r.message, "accessors[0]: with it the file's parts need more than 4 GiB of memory");
  }
}

TEST(Accessors, DecodeMeshoptViews) {
  std::vector<float> numbers;
  for (int i = 0; i < 300; ++i) numbers.push_back(std::sin(0.1f * static_cast<float>(i)));
  Loaded loaded(meshopt_document(numbers));
  EXPECT_EQ(loaded.accessors.floats(0, 3), numbers);
}

TEST(Accessors, RefuseBrokenMeshoptViews) {
  const std::vector<float> numbers(300, 0.5f);
  Document cut = meshopt_document(numbers);
  cut.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["byteLength"] = 8;
  EXPECT_NE(refusal(cut).find("bufferViews[0]: its 8 compressed bytes cannot be decoded"), std::string::npos);
  Document wrong_size = meshopt_document(numbers);
  wrong_size.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["count"] = 99;
  EXPECT_NE(refusal(wrong_size).find("decodes to 1188 bytes, but bufferViews[0] announces 1200"),
            std::string::npos);
  Document wrong_stride = meshopt_document(numbers);
  wrong_stride.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["byteStride"] = 13;
  EXPECT_NE(refusal(wrong_stride).find("does not fit its mode"), std::string::npos);
}

}  // namespace
}  // namespace ukemi::load
