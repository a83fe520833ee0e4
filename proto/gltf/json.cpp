#include "proto/gltf/json.h"

#include <unordered_set>
#include <vector>

#include "proto/problem.h"
#include "proto/text.h"

namespace papilio::proto::gltf {
namespace {

constexpr size_t deepest_document = 64;
constexpr size_t most_values = 4'000'000;
constexpr size_t most_members = 4096;
constexpr uint64_t largest_whole_number = uint64_t{1} << 53;

/// Check of depth, counts and names before the document is built: the library searches the members of an ordered object
/// linearly, and copies nested values recursively.
class DocumentCheck {
 public:
  using number_integer_t = Json::number_integer_t;
  using number_unsigned_t = Json::number_unsigned_t;
  using number_float_t = Json::number_float_t;
  using string_t = Json::string_t;
  using binary_t = Json::binary_t;

  [[nodiscard]] const std::string& fault() const { return fault_; }

  bool null() { return count(); }
  bool boolean(bool) { return count(); }
  bool number_integer(number_integer_t) { return count(); }
  bool number_unsigned(number_unsigned_t) { return count(); }
  bool number_float(number_float_t, const string_t&) { return count(); }
  bool string(const string_t&) { return count(); }
  bool binary(const binary_t&) { return count(); }
  bool start_object(size_t) { return open(); }
  bool start_array(size_t) { return open(); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(const string_t& name) {
    auto& names = names_.back();
    if (!names.insert(name).second) return refuse("names " + quote(name) + " twice in one object");
    return names.size() <= most_members || refuse("has an object of more than 4096 members");
  }
  bool parse_error(size_t byte, const std::string&, const nlohmann::detail::exception&) {
    return refuse("is not valid JSON at byte " + std::to_string(byte));
  }

 private:
  bool refuse(const std::string& fault) {
    fault_ = fault;
    return false;
  }
  bool count() { return ++values_ <= most_values || refuse("has more than 4000000 values"); }
  bool open() {
    names_.emplace_back();
    return count() && (names_.size() <= deepest_document || refuse("is nested deeper than 64 levels"));
  }
  bool close() {
    names_.pop_back();
    return true;
  }

  std::vector<std::unordered_set<std::string>> names_;  ///< member names of the open objects
  size_t values_ = 0;
  std::string fault_;
};

void require_object(const Json& value, const std::string& where) {
  if (!value.is_object()) refuse_document(where, "must be an object");
}

double number_of(const Json& value, const std::string& where) {
  if (!value.is_number()) refuse_document(where, "must be a number");
  return value.get<double>();
}

}  // namespace

void refuse_document(const std::string& where, const std::string& what) {
  throw Problem(Code::mesh_not_gltf, "The glTF document is invalid: " + where + " " + what + ". Export it again.");
}

Json parse_document(std::string_view text) {
  DocumentCheck check;
  if (!Json::sax_parse(text, &check)) refuse_document("the JSON", check.fault());
  Json document = Json::parse(text);
  require_object(document, "the JSON");
  return document;
}

const Json* find_member(const Json& object, const char* key, const std::string& where) {
  require_object(object, where);
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

Json* find_member(Json& object, const char* key, const std::string& where) {
  require_object(object, where);
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

uint64_t whole_number(const Json& object, const char* key, const std::string& where, std::optional<uint64_t> fallback) {
  const Json* value = find_member(object, key, where);
  if (value == nullptr) {
    if (!fallback) refuse_document(where, "has no " + std::string(key));
    return *fallback;
  }
  if (value->is_number_unsigned() && value->get<uint64_t>() < largest_whole_number) return value->get<uint64_t>();
  if (value->is_number_float()) {  // some exporters write 4.0
    const double number = value->get<double>();
    if (number >= 0 && number < static_cast<double>(largest_whole_number)) {
      const auto whole = static_cast<uint64_t>(number);
      if (static_cast<double>(whole) == number) return whole;
    }
  }
  refuse_document(where + "." + key, "must be a whole number, not " + shorten(value->dump()));
}

std::optional<uint32_t> index_member(const Json& object, const char* key, const std::string& where) {
  if (find_member(object, key, where) == nullptr) return std::nullopt;
  const uint64_t index = whole_number(object, key, where);
  if (index >= UINT32_MAX) refuse_document(where + "." + key, "is " + std::to_string(index) + ", which is no index");
  return static_cast<uint32_t>(index);
}

std::string text_member(const Json& object, const char* key, const std::string& where) {
  const Json* value = find_member(object, key, where);
  if (value == nullptr) return {};
  if (!value->is_string()) refuse_document(where + "." + key, "must be a string");
  return value->get<std::string>();
}

bool flag_member(const Json& object, const char* key, const std::string& where) {
  const Json* value = find_member(object, key, where);
  if (value == nullptr) return false;
  if (!value->is_boolean()) refuse_document(where + "." + key, "must be true or false");
  return value->get<bool>();
}

double number_member(const Json& object, const char* key, double fallback, const std::string& where) {
  const Json* value = find_member(object, key, where);
  return value == nullptr ? fallback : number_of(*value, where + "." + key);
}

void read_numbers(const Json& object, const char* key, std::span<double> numbers, const std::string& where) {
  const Json* value = find_member(object, key, where);
  if (value == nullptr) return;
  const std::string name = where + "." + key;
  if (!value->is_array() || value->size() != numbers.size())
    refuse_document(name, "must be " + std::to_string(numbers.size()) + " numbers");
  for (size_t i = 0; i < numbers.size(); ++i) numbers[i] = number_of((*value)[i], name);
}

const Json& array_of(const Json& document, const char* name) {
  static const Json empty = Json::array();
  const Json* found = find_member(document, name, "the JSON");
  if (found == nullptr) return empty;
  if (!found->is_array()) refuse_document(name, "must be an array");
  return *found;
}

const Json& element_of(const Json& document, const char* name, uint64_t index, std::string_view where) {
  const Json& array = array_of(document, name);
  if (index >= array.size())
    refuse_document(std::string(where),
                    "refers to " + place(name, index) + ", and there are " + std::to_string(array.size()));
  require_object(array[index], place(name, index));
  return array[index];
}

const Json* find_extension(const Json& object, const char* name, const std::string& where) {
  const Json* extensions = find_member(object, "extensions", where);
  if (extensions == nullptr) return nullptr;
  const Json* found = find_member(*extensions, name, where + ".extensions");
  if (found != nullptr) require_object(*found, where + ".extensions." + name);
  return found;
}

void erase_extension(Json& object, const char* name) {
  const auto extensions = object.find("extensions");
  if (extensions == object.end()) return;
  extensions->erase(name);
  if (extensions->empty()) object.erase("extensions");
}

std::string place(const char* array, uint64_t index) { return std::string(array) + "[" + std::to_string(index) + "]"; }

}  // namespace papilio::proto::gltf
