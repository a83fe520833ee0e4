#include "server/file_bytes.h"

#include <fstream>
#include <iterator>

namespace papilio::server {

std::shared_ptr<const std::string> read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return nullptr;
  auto bytes =
      std::make_shared<const std::string>(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  return in.bad() ? nullptr : bytes;
}

}  // namespace papilio::server
