#include "fbx/material_records.h"

#include <string>

namespace ukemi {
namespace {

/// The image as a file inside the file, and the texture that shows it.
std::int64_t add_texture(const Image& image, int index, FbxRecords& records) {
  const std::int64_t video = records.ids.next();
  const std::int64_t texture = records.ids.next();
  const std::string file =
      "texture_" + std::to_string(index) + (image.mime == "image/jpeg" ? ".jpg" : ".png");
  const FbxRecord path = property_record("Path", "KString", "XRefUrl", "", {fbx_text(file)});
  records.objects.push_back(fbx_branch(
      "Video", {fbx_long(video), fbx_text(object_name(file, "Video")), fbx_text("Clip")},
      {fbx_leaf("Type", {fbx_text("Clip")}), fbx_branch("Properties70", {}, {path}),
       fbx_leaf("UseMipMap", {fbx_int(0)}), fbx_leaf("Filename", {fbx_text(file)}),
       fbx_leaf("RelativeFilename", {fbx_text(file)}), fbx_leaf("Content", {fbx_bytes(image.bytes)})}));
  records.objects.push_back(
      fbx_branch("Texture", {fbx_long(texture), fbx_text(object_name(file, "Texture")), fbx_text("")},
                 {fbx_leaf("Type", {fbx_text("TextureVideoClip")}), fbx_leaf("Version", {fbx_int(202)}),
                  fbx_leaf("TextureName", {fbx_text(object_name(file, "Texture"))}),
                  fbx_leaf("Media", {fbx_text(object_name(file, "Video"))}),
                  fbx_leaf("FileName", {fbx_text(file)}), fbx_leaf("RelativeFilename", {fbx_text(file)})}));
  records.connections.push_back(connection(video, texture));
  return texture;
}

FbxRecord material_record(std::int64_t id, const Material& material, const std::string& name) {
  const auto color = [](const char* property, float r, float g, float b) {
    return property_record(property, "Color", "", "A", {fbx_double(r), fbx_double(g), fbx_double(b)});
  };
  const auto number = [](const char* property, double value) {
    return property_record(property, "Number", "", "A", {fbx_double(value)});
  };
  const auto& base = material.base_color;
  const double opacity = material.alpha == Material::Alpha::opaque ? 1.0 : static_cast<double>(base[3]);
  return fbx_branch(
      "Material", {fbx_long(id), fbx_text(object_name(name, "Material")), fbx_text("")},
      {fbx_leaf("Version", {fbx_int(102)}), fbx_leaf("ShadingModel", {fbx_text("lambert")}),
       fbx_leaf("MultiLayer", {fbx_int(0)}),
       fbx_branch("Properties70", {},
                  {color("DiffuseColor", base[0], base[1], base[2]), number("DiffuseFactor", 1.0),
                   number("TransparencyFactor", 1.0 - opacity), number("Opacity", opacity)})});
}

}  // namespace

std::map<int, std::int64_t> add_materials(const FbxScene& scene, FbxRecords& records) {
  std::map<int, std::int64_t> ids;
  std::map<int, std::int64_t> textures;
  const Character& character = scene.character;
  for (const MeshPart& part : scene.parts) {
    const auto [entry, is_new] = ids.try_emplace(part.material, 0);
    if (!is_new) continue;
    entry->second = records.ids.next();
    const bool known = part.material >= 0 && part.material < static_cast<int>(character.materials.size());
    const Material material = known ? character.materials[part.material] : Material{};
    records.objects.push_back(material_record(entry->second, material, fbx_name(material.name, "material")));
    const int image = material.base_color_image;
    if (image < 0 || image >= static_cast<int>(character.images.size())) continue;
    const auto [texture, fresh] = textures.try_emplace(image, 0);
    if (fresh) texture->second = add_texture(character.images[image], image, records);
    records.connections.push_back(connection(texture->second, entry->second, "DiffuseColor"));
  }
  return ids;
}

}  // namespace ukemi
