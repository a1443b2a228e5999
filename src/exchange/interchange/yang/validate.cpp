// SPDX-License-Identifier: Apache-2.0
#include "interchange/yang/validate.hpp"

#include <filesystem>
#include <memory>

#include "interchange/device_import.hpp"
#include "interchange/yang/schema.hpp"
#include "sim/check.hpp"

#ifdef TAKT_WITH_LIBYANG
#include <libyang/libyang.h>
#endif

namespace takt::interchange {

#ifdef TAKT_WITH_LIBYANG

namespace {

struct ContextEnd {
  void operator()(ly_ctx* context) const { ly_ctx_destroy(context); }
};
using Context = std::unique_ptr<ly_ctx, ContextEnd>;

struct DataEnd {
  void operator()(lyd_node* tree) const { lyd_free_all(tree); }
};

/// The first error that libyang has kept; what follows from it is no news.
std::string error_of(const ly_ctx& context) {
  for (const ly_err_item* each = ly_err_first(&context); each != nullptr; each = each->next)
    if (each->level == LY_LLERR)
      return std::string(each->msg == nullptr ? "an error without words" : each->msg) +
             (each->path == nullptr ? "" : " (" + std::string(each->path) + ")");
  return "an error without words";
}

/// Where modules are looked for; corrected ones first.
std::vector<std::string> search_folders(const std::string& folder, bool is_2018) {
  namespace fs = std::filesystem;
  std::vector<std::string> folders;
  std::error_code error;
  for (const char* const part : is_2018 ? std::initializer_list<const char*>{"2018", "ietf"}
                                        : std::initializer_list<const char*>{"fixes", "published", "ietf"})
    if (fs::is_directory(fs::path(folder) / part, error)) folders.push_back((fs::path(folder) / part).string());
  if (folders.empty()) folders.push_back(folder);
  return folders;
}

/// Loads what the text names; a mistake is a text.
std::string load_modules(ly_ctx& context, const std::string& text) {
  for (const std::string_view module : yang::known_modules()) {
    const bool is_named = text.find("\"" + std::string(module) + ":") != std::string::npos ||
                          text.find("\"" + std::string(yang::namespace_of(module)) + "\"") != std::string::npos;
    if (!is_named) continue;
    const char* all_features[] = {"*", nullptr};
    if (ly_ctx_load_module(&context, std::string(module).c_str(), nullptr, all_features) == nullptr)
      return "module " + std::string(module) + ": " + error_of(context);
  }
  return {};
}

}  // namespace

bool can_validate_yang() { return true; }

YangValidation validate_yang(std::span<const OutputFile> files, bool is_2018, const std::string& folder) {
  YangValidation result;
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error))
    return {"found " + folder + ", expected a folder with YANG modules"};
  ly_log_options(LY_LOSTORE);  // keep messages, print none
  ly_ctx* made = nullptr;
  if (ly_ctx_new(nullptr, LY_CTX_DISABLE_SEARCHDIR_CWD, &made) != LY_SUCCESS) return {"libyang does not begin"};
  const Context context(made);
  for (const std::string& each : search_folders(folder, is_2018))
    if (ly_ctx_set_searchdir(context.get(), each.c_str()) != LY_SUCCESS) return {each + ": " + error_of(*context)};
  for (const OutputFile& file : files) {
    if (file.name.ends_with(names_file)) continue;
    if (std::string mistake = load_modules(*context, file.content); !mistake.empty()) return {std::move(mistake)};
    ly_err_clean(context.get(), nullptr);
    lyd_node* tree = nullptr;
    const LYD_FORMAT format = file.name.ends_with(".xml") ? LYD_XML : LYD_JSON;
    const LY_ERR outcome =
        lyd_parse_data_mem(context.get(), file.content.c_str(), format, LYD_PARSE_STRICT | LYD_PARSE_NO_STATE,
                           LYD_VALIDATE_NO_STATE | LYD_VALIDATE_PRESENT, &tree);
    const std::unique_ptr<lyd_node, DataEnd> end(tree);
    if (outcome != LY_SUCCESS) result.invalid.push_back(file.name + ": " + error_of(*context));
  }
  return result;
}

#else

bool can_validate_yang() { return false; }

YangValidation validate_yang(std::span<const OutputFile>, bool, const std::string&) {
  TAKT_CHECK(can_validate_yang(), "asked only where libyang is there");
  return {};
}

#endif

}  // namespace takt::interchange
