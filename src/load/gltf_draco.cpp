#include "load/gltf_draco.h"

#include <fmt/format.h>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wextra"
#include <draco/compression/decode.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cmath>

namespace ukemi::load {
namespace {

std::vector<float> attribute_values(const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                                    const JsonView& place, int accessor, Accessors& accessors) {
  const int components = accessors.components(accessor);
  const auto width = static_cast<std::size_t>(components);
  accessors.budget().spend(mesh.num_points() * width * sizeof(float), place.place());
  std::vector<float> values(mesh.num_points() * width);
  for (std::uint32_t point = 0; point < mesh.num_points(); ++point) {
    const auto value = attribute.mapped_index(draco::PointIndex(point));
    if (value.value() >= attribute.size() ||
        !attribute.ConvertValue<float>(value, static_cast<std::int8_t>(components),
                                       values.data() + point * width))
      place.refuse(fmt::format("cannot be decoded at vertex {}", point));
  }
  if (accessors.normalized(accessor) && !attribute.normalized()) {
    const auto one = static_cast<float>(largest(accessors.component_type(accessor)));
    for (float& v : values) v = std::max(v / one, -1.0f);
  }
  for (const float v : values)
    if (!std::isfinite(v)) place.refuse("has a value that is not finite");
  return values;
}

}  // namespace

DracoMesh decode_draco(const JsonView& extension, const JsonView& primitive, Accessors& accessors) {
  const int view = extension.at("bufferView").index(accessors.view_count(), "bufferViews");
  const auto bytes = accessors.view_bytes(view);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    extension.refuse(
        fmt::format("cannot be decoded ({}, {} bytes)", decoded.status().error_msg_string(), bytes.size()));
  const draco::Mesh& mesh = *decoded.value();

  DracoMesh result;
  accessors.budget().spend(std::size_t{mesh.num_faces()} * 12, extension.place());
  result.vertex_count = mesh.num_points();
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f)
    for (const auto& point : mesh.face(draco::FaceIndex(f))) result.indices.push_back(point.value());
  const JsonView described = primitive.at("attributes");
  for (const auto& [name, id] : extension.at("attributes").members()) {
    const auto unique_id = static_cast<std::uint32_t>(id.integer(0, 1 << 16));
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(unique_id);
    if (attribute == nullptr)
      id.refuse(fmt::format("is {}, which the compressed mesh does not have", unique_id));
    const int accessor = described.at(name.c_str()).index(accessors.size(), "accessors");
    result.attributes[name] = attribute_values(mesh, *attribute, id, accessor, accessors);
  }
  return result;
}

}  // namespace ukemi::load
