// SPDX-License-Identifier: Apache-2.0
// From JSON and XML to data by the schema.
#include <algorithm>
#include <map>

#include "xml/xml.hpp"
#include "interchange/yang/data.hpp"
#include "interchange/yang/modules.hpp"
#include "json/document.hpp"
#include "json/suggest.hpp"

namespace takt::interchange::yang {
namespace {

constexpr std::string_view netconf = "urn:ietf:params:xml:ns:netconf:base:1.0";

void refuse_unknown(const Schema& parent, std::string_view module, std::string_view name, const json::Place& place,
                    json::Diagnostics& diagnostics) {
  std::vector<std::string_view> names;
  for (const Schema& each : parent.children) names.push_back(each.name);
  std::string expected = parent.name.empty() ? "what stands at the top of a module that takt knows"
                                             : "a child of " + std::string(parent.name);
  if (name.starts_with("gate-parameter") || name == "max-sdu-table")
    expected += ". Known are the published modules (802.1Qcw-2023) and those of 2018, not the drafts between";
  diagnostics.error(
      place, "not in the module",
      {json::quote(std::string(module) + ":" + std::string(name)), std::move(expected), json::suggest(name, names)});
}

std::string unheard(const Schema& schema) { return std::string(schema.name) + ", which takt does not have"; }

}  // namespace

class JsonToData {
 public:
  JsonToData(DataReader& reader, const json::Document& document)
      : reader_(reader), document_(document), leaves_(reader.diagnostics_) {}

  void read_children(const json::Node& node, Data& data) {
    for (const json::Member& member : node.members) {
      if (member.key.starts_with('@')) continue;  // metadata, such as the operation of an edit
      const std::size_t colon = member.key.find(':');
      const std::string_view name = std::string_view(member.key).substr(colon == std::string::npos ? 0 : colon + 1);
      const std::string_view module =
          colon == std::string::npos ? data.schema->module : std::string_view(member.key).substr(0, colon);
      const json::Place at = json::place_of(*document_.tree(), member.key_position, json::pointer_of(member.value));
      if (module.empty()) {
        reader_.diagnostics_.error(at, "a name without its module",
                                   {json::quote(member.key), "MODULE:NAME at the top"});
        continue;
      }
      const Schema* const schema = data.schema->find(module, name);
      if (schema != nullptr)
        read_member(member.value, *schema, data);
      else if (!is_known(module))
        reader_.imported_.remark(RemarkKind::ignored, at,
                                 "module " + std::string(module) + ", which says nothing that takt has");
      else
        refuse_unknown(*data.schema, module, name, at, reader_.diagnostics_);
    }
    leaves_.check_children(data);
  }

 private:
  json::Place place(const json::Node& node) const { return json::place_of(*document_.tree(), node); }
  bool expect(const json::Node& node, json::Kind kind, const Schema& schema, std::string expected) {
    if (node.kind == kind) return true;
    reader_.diagnostics_.error(place(node), "the wrong kind of value",
                               {json::excerpt(node) + " for " + std::string(schema.name), std::move(expected)});
    return false;
  }

  void read_member(const json::Node& node, const Schema& schema, Data& parent) {
    if (schema.type == Type::anything) {
      if (!schema.is_state) reader_.imported_.remark(RemarkKind::ignored, place(node), unheard(schema));
      return;
    }
    if (schema.type == Type::list || schema.is_leaf_list) {
      if (!expect(node, json::Kind::array, schema, "an array, since it is a list")) return;
      for (const json::Node& item : node.items) read_one(item, schema, parent);
    } else {
      read_one(node, schema, parent);
    }
  }

  void read_one(const json::Node& node, const Schema& schema, Data& parent) {
    Data data{&schema, place(node), {}, {}, false};
    if (schema.type == Type::list || schema.type == Type::container) {
      if (!expect(node, json::Kind::object, schema, "an object")) return;
      read_children(node, data);
    } else if (!read_leaf(node, schema, data)) {
      return;
    }
    parent.children.push_back(std::move(data));
  }

  /// RFC 7951: numbers of 64 bits are texts, the others are not; empty is [null].
  bool read_leaf(const json::Node& node, const Schema& schema, Data& data) {
    switch (schema.type) {
      case Type::boolean:
        if (!expect(node, json::Kind::boolean, schema, "true or false")) return false;
        data.text = node.boolean ? "true" : "false";
        return true;
      case Type::empty:
        return (node.kind == json::Kind::array && node.items.size() == 1 && node.items[0].kind == json::Kind::null) ||
               expect(node, json::Kind::null, schema, "[null]");
      case Type::uint8:
      case Type::uint16:
      case Type::uint32:
      case Type::int8:
      case Type::int16:
      case Type::int32:
        if (!expect(node, json::Kind::number, schema, "a number")) return false;
        break;
      case Type::uint64:
      case Type::int64:
        if (!expect(node, json::Kind::string, schema, "a text with a number, as all of 64 bits")) return false;
        break;
      default:
        if (!expect(node, json::Kind::string, schema, "a text")) return false;
    }
    data.text = node.text;
    if (schema.type == Type::identity && data.text.find(':') == std::string::npos)
      data.text = std::string(schema.module) + ":" + data.text;
    return leaves_.check(schema, data.text, data.place);
  }

  DataReader& reader_;
  const json::Document& document_;
  LeafCheck leaves_;
};

class XmlToData {
 public:
  explicit XmlToData(DataReader& reader) : reader_(reader), leaves_(reader.diagnostics_) {}

  void read_children(const std::vector<XmlElement>& elements, Data& data) {
    for (const XmlElement& element : elements) read(element, data);
    leaves_.check_children(data);
  }

 private:
  void read(const XmlElement& element, Data& parent) {
    // What an edit or a reply is wrapped in.
    if (element.name_space == netconf && parent.schema->name.empty()) {
      for (const XmlElement& child : element.children) read(child, parent);
      return;
    }
    const std::string_view module = module_of(element.name_space);
    if (module.empty()) {
      reader_.imported_.remark(RemarkKind::ignored, element.place,
                               json::quote(element.name) + " of " +
                                   (element.name_space.empty() ? "no module" : element.name_space) +
                                   ", which says nothing that takt has");
      return;
    }
    const Schema* const schema = parent.schema->find(module, element.name);
    if (schema == nullptr)
      return refuse_unknown(*parent.schema, module, element.name, element.place, reader_.diagnostics_);
    if (schema->type == Type::anything) {
      if (!schema->is_state) reader_.imported_.remark(RemarkKind::ignored, element.place, unheard(*schema));
      return;
    }
    Data data{schema, element.place, {}, {}, parent.is_deleted};
    for (const XmlAttribute& attribute : element.attributes)
      if (attribute.name_space == netconf && attribute.name == "operation")
        data.is_deleted = data.is_deleted || attribute.value == "delete" || attribute.value == "remove";
    if (schema->type == Type::list || schema->type == Type::container) {
      scopes_.push_back(&element);
      read_children(element.children, data);
      scopes_.pop_back();
    } else {
      data.text = element.text;
      if (schema->type == Type::identity) data.text = with_module(element, *schema);
      if (!leaves_.check(*schema, data.text, element.place)) return;
    }
    if (!data.is_deleted) parent.children.push_back(std::move(data));
  }

  /// "sched:set-gate-states" with its prefix to the module's name; without a prefix the default namespace counts, else
  /// the leaf's module.
  std::string with_module(const XmlElement& element, const Schema& schema) const {
    const std::size_t colon = element.text.find(':');
    const std::string prefix = colon == std::string::npos ? "" : element.text.substr(0, colon);
    const std::string name = colon == std::string::npos ? element.text : element.text.substr(colon + 1);
    const auto look = [&](const XmlElement& in) -> std::optional<std::string> {
      for (const auto& [declared, name_space] : in.declared)
        if (declared == prefix) return std::string(module_of(name_space));
      return std::nullopt;
    };
    std::optional<std::string> module = look(element);
    for (auto scope = scopes_.rbegin(); scope != scopes_.rend() && !module; ++scope) module = look(**scope);
    if (prefix.empty() && (!module || schema.choices.find(*module + ":" + name) == std::string_view::npos))
      module = schema.module;
    return module.value_or(prefix) + ":" + name;
  }

  DataReader& reader_;
  LeafCheck leaves_;
  std::vector<const XmlElement*> scopes_;
};

std::optional<Dialect> DataReader::dialect_of(const InputFile& file) {
  // What only one of them has, as a name in JSON or XML.
  constexpr std::string_view only_2018[] = {"gate-parameters",
                                            "sgs-params",
                                            "fractional-seconds",
                                            "max-sdu-table",
                                            "ieee802-dot1q-stream-filters-gates",
                                            "ieee802-dot1q-stream-id",
                                            "ieee802-dot1q-cb-stream-identification",
                                            "yang:ieee802-dot1q-preemption\"",
                                            "ieee802-dot1q-preemption:",
                                            "traffic-class-map",
                                            "flow-meter-instance-table"};
  constexpr std::string_view only_published[] = {"gate-parameter-table", "queue-max-sdu-table", "-psfp-bridge",
                                                 "-ats-bridge",          "-sched-bridge",       "-preemption-bridge",
                                                 "-cbsa-bridge",         "ieee802-dot1cb-"};
  const auto says = [&](std::string_view name) {
    for (std::size_t at = file.text.find(name); at != std::string::npos; at = file.text.find(name, at + 1)) {
      if (name == "max-sdu-table" && at >= 6 && file.text.compare(at - 6, 6, "queue-") == 0) continue;
      return true;
    }
    return false;
  };
  const bool is_published = std::ranges::any_of(only_published, says);
  const bool is_2018 =
      std::ranges::any_of(std::span(only_2018).first(10), says) || (!is_published && says(only_2018[10]));
  // Vendors' files bind names of both; what is used is told by reading.
  return is_2018 && !is_published ? Dialect::of_2018 : Dialect::published;
}

std::optional<Data> DataReader::read(const InputFile& file, Dialect dialect) {
  Data root{&root_of(dialect), {file.name, 0, 0, ""}, {}, {}, false};
  const std::size_t first = file.text.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && file.text[first] == '<') {
    const auto elements = parse_xml(file.text, file.name, diagnostics_);
    if (!elements) return std::nullopt;
    XmlToData(*this).read_children(*elements, root);
  } else {
    const auto document = json::parse(file.text, file.name, diagnostics_);
    if (!document) return std::nullopt;
    if (document->root().kind != json::Kind::object) {
      diagnostics_.error(json::place_of(*document->tree(), document->root()), "no instance data",
                         {json::excerpt(document->root()), "an object"});
      return std::nullopt;
    }
    JsonToData(*this, *document).read_children(document->root(), root);
  }
  return root;
}

}  // namespace takt::interchange::yang
