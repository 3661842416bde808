#include "tools/report/provenance.h"

#include <array>
#include <fstream>
#include <memory>

#include <openssl/evp.h>

#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>

namespace gonio {

std::string sha256_of(const std::filesystem::path& path) {
  regular_file_size(path);  // a pipe would wait for what never comes
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  bool good = context && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
  std::ifstream in(path, std::ios::binary);
  std::array<char, 1 << 16> block;
  while (good && in) {
    in.read(block.data(), block.size());
    good = EVP_DigestUpdate(context.get(), block.data(), static_cast<std::size_t>(in.gcount())) == 1;
  }
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned size = 0;
  good = good && in.eof() && EVP_DigestFinal_ex(context.get(), digest, &size) == 1;
  if (!good) throw Error(path.string() + ": cannot be read for its SHA-256");
  std::string text;
  for (unsigned k = 0; k < size; ++k)
    for (const int digit : {digest[k] >> 4, digest[k] & 15}) text += "0123456789abcdef"[digit];
  return text;
}

std::string command_line(const std::vector<std::string>& arguments) {
  std::string line = "gonio";
  for (const std::string& argument : arguments) {
    const bool plain =
        !argument.empty() &&
        argument.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:=,+-@%") ==
            std::string::npos;
    line += ' ';
    if (plain) {
      line += argument;
      continue;
    }
    line += '\'';
    for (const char c : argument) c == '\'' ? line += "'\\''" : line += c;
    line += '\'';
  }
  return line;
}

}  // namespace gonio
