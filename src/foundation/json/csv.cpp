// SPDX-License-Identifier: Apache-2.0
#include "json/csv.hpp"

#include <optional>

#include "json/printable.hpp"

namespace takt::json {
namespace {

std::string sum_of(const Node& object) {
  sim::int128 sum = 0;
  for (const Member& member : object.members) sum += integer_of(member.value).value_or(0);
  return to_text(sum);
}

std::string text_at(const Node* node, std::string_view pointer) {
  while (!pointer.empty() && node != nullptr) {
    const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
    const std::string_view step = pointer.substr(1, end - 1);
    if (step == "*") return sum_of(*node);
    node = node->find(step);
    pointer.remove_prefix(end);
  }
  if (node == nullptr || node->kind == Kind::null) return "";
  if (node->kind == Kind::boolean) return node->boolean ? "1" : "0";
  return csv_field(node->text);
}

void end_line(std::string& out) { out.back() = '\n'; }

}  // namespace

std::string csv(std::span<const std::string_view> first, std::span<const Column> columns, std::span<const Row> rows) {
  std::string out;
  for (const std::string_view name : first) out += std::string(name) + ',';
  for (const Column& column : columns) out += std::string(column.name) + ',';
  end_line(out);
  for (const Row& row : rows) {
    for (const std::string& text : row.first) out += csv_field(text) + ',';
    for (const Column& column : columns) out += text_at(row.object, column.pointer) + ',';
    end_line(out);
  }
  return out;
}

}  // namespace takt::json
