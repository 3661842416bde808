#include <gonio/mapping/error.h>
#include <gonio/tools/each_file.h>

#include <new>

namespace gonio {

void for_each_file(const std::vector<std::string>& files, const std::function<void(const std::string& file)>& work) {
  std::vector<std::string> failed;
  for (const std::string& file : files) {
    try {
      work(file);
    } catch (const Error& error) {
      const std::string why = error.what();
      failed.push_back(why.find(file) == std::string::npos ? file + ": " + why : why);
    } catch (const std::bad_alloc&) {
      failed.push_back(file + ": not enough memory");
    }
  }
  if (failed.empty()) return;
  if (files.size() == 1) throw Error(failed.front());
  std::string all;
  for (const std::string& why : failed) all += (all.empty() ? "" : "; ") + why;
  throw Error(std::to_string(failed.size()) + " of " + std::to_string(files.size()) + " files failed: " + all);
}

}  // namespace gonio
