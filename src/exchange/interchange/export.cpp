// SPDX-License-Identifier: Apache-2.0
#include "interchange/export.hpp"

#include <algorithm>

namespace takt::interchange {

void Exported::lose(std::string where, std::string what) {
  Loss loss{std::move(where), std::move(what)};
  if (std::ranges::find(losses, loss) == losses.end()) losses.push_back(std::move(loss));
}

std::string losses_as_comments(const std::vector<Loss>& losses, std::string_view mark) {
  std::string text;
  for (const Loss& loss : losses) text += std::string(mark) + "cannot be said: " + loss.where + ": " + loss.what + "\n";
  return text;
}

}  // namespace takt::interchange
