#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

// JSON of glTF: members keep their order, and unknown ones are kept.

namespace papilio::proto::gltf {

using Json = nlohmann::ordered_json;

/// Parses the JSON of a glTF document with bounded work: at most 64 levels deep, 4 million values, 4096 members of an
/// object, each named once. Throws `Problem` mesh_not_gltf.
[[nodiscard]] Json parse_document(std::string_view text);

/// Throws `Problem` mesh_not_gltf: "WHERE WHAT. Export the scene again."
[[noreturn]] void refuse_document(const std::string& where, const std::string& what);

/// Returns whether a value is this text. (GCC 12 reports the comparison of JSON with text as out of bounds.)
[[nodiscard]] inline bool is_text(const Json& value, std::string_view text) {
  return value.is_string() && value.get_ref<const std::string&>() == text;
}

/// Returns a member of an object; null if it is absent. `where` names the object in the error for other values.
[[nodiscard]] const Json* find_member(const Json& object, const char* key, const std::string& where);
[[nodiscard]] Json* find_member(Json& object, const char* key, const std::string& where);

/// Returns a member that is a whole number below 2^53, or `fallback` if it is absent. Throws `Problem` for other
/// values, and for an absent one without `fallback`.
[[nodiscard]] uint64_t whole_number(const Json& object, const char* key, const std::string& where,
                                    std::optional<uint64_t> fallback = std::nullopt);
/// Returns a member that is an index, if it is there.
[[nodiscard]] std::optional<uint32_t> index_member(const Json& object, const char* key, const std::string& where);
/// Returns a member that is a string; "" if it is absent.
[[nodiscard]] std::string text_member(const Json& object, const char* key, const std::string& where);
[[nodiscard]] bool flag_member(const Json& object, const char* key, const std::string& where);
/// Returns a member that is a number; `fallback` if it is absent.
[[nodiscard]] double number_member(const Json& object, const char* key, double fallback, const std::string& where);
/// Replaces the numbers by the elements of a member, if it exists. Throws `Problem` for another count.
void read_numbers(const Json& object, const char* key, std::span<double> numbers, const std::string& where);

/// Returns a top-level array of the document; an empty one if it is absent.
[[nodiscard]] const Json& array_of(const Json& document, const char* name);
/// Returns an element of a top-level array. Throws `Problem` if it does not exist; `where` names the referring object.
/// `where` is a view, as compilers would report the returned reference as dangling with a string.
[[nodiscard]] const Json& element_of(const Json& document, const char* name, uint64_t index, std::string_view where);

/// Returns the extension `name` of an object; null if it has none.
[[nodiscard]] const Json* find_extension(const Json& object, const char* name, const std::string& where);
/// Removes the extension `name` of an object, if it has one.
void erase_extension(Json& object, const char* name);

/// Returns "meshes[3]".
[[nodiscard]] std::string place(const char* array, uint64_t index);

}  // namespace papilio::proto::gltf
