// SPDX-License-Identifier: Apache-2.0
#include "schedule_instances/pick.hpp"

#include <fmt/format.h>

#include <cmath>

namespace takt::schedule_instances {

using json::Kind;
using json::Node;

Pick::Pick(json::Reader& reader, const Node& object) : reader_(&reader), node_(object) {
  if (object.kind != Kind::object) reader.wrong_type(object, "an object");
}

const Node* Pick::find(std::string_view key) const {
  const Node* const found = node_.kind == Kind::object ? node_.find(key) : nullptr;
  return found != nullptr && found->kind == Kind::null ? nullptr : found;
}

const Node* Pick::need(std::string_view key) const {
  const Node* const found = find(key);
  if (found == nullptr && node_.kind == Kind::object) reader_->error(node_, fmt::format("missing \"{}\"", key));
  return found;
}

const Node* Pick::need_array(std::string_view key) const {
  const Node* const found = need(key);
  if (found == nullptr || found->kind == Kind::array) return found;
  reader_->wrong_type(*found, "an array");
  return nullptr;
}

std::string Pick::text(std::string_view key) const {
  const Node* const found = need(key);
  return found == nullptr ? std::string() : text_of(*reader_, *found);
}

bool Pick::truth(std::string_view key, std::optional<bool> otherwise) const {
  const Node* const found = otherwise ? find(key) : need(key);
  if (found == nullptr) return otherwise.value_or(false);
  if (found->kind != Kind::boolean) reader_->wrong_type(*found, "true or false");
  return found->boolean;
}

std::int64_t Pick::whole(std::string_view key, Range range, std::optional<std::int64_t> otherwise) const {
  const Node* const found = otherwise ? find(key) : need(key);
  return found == nullptr ? otherwise.value_or(range.least) : whole_of(*reader_, *found, range);
}

std::optional<std::int64_t> Pick::whole_if_any(std::string_view key, Range range) const {
  const Node* const found = find(key);
  return found == nullptr ? std::nullopt : std::optional(whole_of(*reader_, *found, range));
}

std::int64_t Pick::scaled(std::string_view key, double unit, Range range, std::optional<std::int64_t> otherwise) const {
  const Node* const found = otherwise ? find(key) : need(key);
  return found == nullptr ? otherwise.value_or(range.least) : scaled_of(*reader_, *found, unit, range);
}

std::optional<std::int64_t> Pick::scaled_if_any(std::string_view key, double unit, Range range) const {
  const Node* const found = find(key);
  return found == nullptr ? std::nullopt : std::optional(scaled_of(*reader_, *found, unit, range));
}

std::string text_of(json::Reader& reader, const Node& node) {
  if (node.kind == Kind::string && !node.text.empty()) return node.text;
  if (node.kind == Kind::number && json::integer_of(node)) return node.text;  // names that are numbers
  reader.wrong_type(node, "a name");
  return {};
}

std::int64_t whole_of(json::Reader& reader, const Node& node, Range range) {
  const auto value = node.kind == Kind::number ? json::integer_of(node) : std::nullopt;
  if (value && *value >= range.least && *value <= range.most) return static_cast<std::int64_t>(*value);
  if (node.kind == Kind::number && !value) return scaled_of(reader, node, 1, range);
  reader.error(node, "not in range",
               {json::excerpt(node), fmt::format("a whole number from {} to {}", range.least, range.most)});
  return range.least;
}

std::int64_t scaled_of(json::Reader& reader, const Node& node, double unit, Range range) {
  if (node.kind != Kind::number) {
    reader.wrong_type(node, "a number");
    return range.least;
  }
  const double value = json::double_of(node) * unit;
  if (!(value >= static_cast<double>(range.least) && value <= static_cast<double>(range.most))) {
    reader.error(
        node, "not in range",
        {json::excerpt(node), fmt::format("a number from {:g} to {:g}", static_cast<double>(range.least) / unit,
                                          static_cast<double>(range.most) / unit)});
    return range.least;
  }
  const double near = std::nearbyint(value);
  if (std::abs(value - near) > std::max(0.01, std::abs(value) * 1e-12))
    reader.error(node, "too fine", {json::excerpt(node), "a whole number of the units that are counted in"});
  return static_cast<std::int64_t>(near);
}

}  // namespace takt::schedule_instances
