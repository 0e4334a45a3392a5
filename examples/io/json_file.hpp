// JSON input: whole documents, errors as one line with the file and, where it is known, the line.
#ifndef TEXTSLAM_IO_JSON_FILE_HPP
#define TEXTSLAM_IO_JSON_FILE_HPP

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "io/input_error.hpp"
#include "io/names.hpp"

namespace textslam {

/// The document. Throws InputError, with the line for text that is not JSON, without one for a file that cannot be
/// read.
nlohmann::json read_json(const std::string& path);

/// A whole number that an int holds. Throws std::out_of_range for another number, nlohmann::json::exception for
/// anything else.
int to_int(const nlohmann::json& json);

/// Three finite numbers. Throws nlohmann::json::exception for anything else.
Vector3<double> to_vector3(const nlohmann::json& json);

/// Calls `read(entry)` for every entry of the list `name` of the document. Throws InputError that names the list and
/// the entry for a missing or mistyped field.
template <class Read>
void for_each_entry(const nlohmann::json& document, const std::string& name, const std::string& path, Read read) {
  const auto list = document.is_object() ? document.find(name) : document.end();
  if (list == document.end() || !list->is_array()) throw InputError(path, 0, "no list '" + name + "'");
  for (std::size_t i = 0; i < list->size(); ++i) {
    try {
      read((*list)[i]);
    } catch (const nlohmann::json::exception& error) {
      throw InputError(path, 0, name + "[" + std::to_string(i) + "]: " + error.what());
    } catch (const std::out_of_range& error) {
      throw InputError(path, 0, name + "[" + std::to_string(i) + "]: " + error.what());
    }
  }
}

}  // namespace textslam

#endif  // TEXTSLAM_IO_JSON_FILE_HPP
