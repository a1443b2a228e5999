// SPDX-License-Identifier: Apache-2.0
#include "xml/xml.hpp"

#include <expat.h>

#include <algorithm>
#include <memory>

#include "json/node.hpp"

namespace takt {
namespace {

/// Between a namespace and a name, and a name and its prefix; no name has it.
constexpr char between = '\x01';
/// What instance data with several elements at the top is wrapped in, so that it is one document.
constexpr std::string_view opening = "<takt-top>";
constexpr std::string_view closing = "</takt-top>";

std::string trimmed(const std::string& text) {
  constexpr std::string_view blank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

class Parser {
 public:
  Parser(std::string_view text, const std::string& file, json::Diagnostics& diagnostics)
      : text_(text),
        file_(file),
        diagnostics_(diagnostics),
        parser_(XML_ParserCreateNS("UTF-8", between), &XML_ParserFree) {
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(
        parser_.get(),
        [](void* self, const XML_Char* name, const XML_Char** attributes) {
          static_cast<Parser*>(self)->start(name, attributes);
        },
        [](void* self, const XML_Char*) { static_cast<Parser*>(self)->end(); });
    XML_SetCharacterDataHandler(parser_.get(), [](void* self, const XML_Char* data, int length) {
      static_cast<Parser*>(self)->characters({data, static_cast<std::size_t>(length)});
    });
    XML_SetStartNamespaceDeclHandler(parser_.get(), [](void* self, const XML_Char* prefix, const XML_Char* uri) {
      static_cast<Parser*>(self)->declared_.emplace_back(prefix == nullptr ? "" : prefix, uri == nullptr ? "" : uri);
    });
    XML_SetStartDoctypeDeclHandler(
        parser_.get(), [](void* self, const XML_Char*, const XML_Char*, const XML_Char*, int) {
          static_cast<Parser*>(self)->stop("a document type, which could make a text expand", "elements only");
        });
  }

  std::optional<std::vector<XmlElement>> run() {
    // An XML declaration may only stand at the very beginning, before what is wrapped around.
    std::string_view body = text_;
    if (const std::size_t start = body.find_first_not_of(" \t\r\n");
        start != std::string_view::npos && body.substr(start).starts_with("<?xml"))
      if (const std::size_t end = body.find("?>"); end != std::string_view::npos) {
        for (const char c : body.substr(0, end + 2)) {
          if (c == '\n') {
            ++lines_before_;
            columns_before_ = 0;
          } else {
            ++columns_before_;
          }
        }
        body.remove_prefix(end + 2);
      }
    std::string whole;
    whole.reserve(body.size() + opening.size() + closing.size());
    whole += opening;
    whole += body;
    whole += closing;
    if (XML_Parse(parser_.get(), whole.data(), static_cast<int>(whole.size()), 1) != XML_STATUS_OK && !is_stopped_) {
      const XML_Error code = XML_GetErrorCode(parser_.get());
      diagnostics_.error(place(), "not XML", {XML_ErrorString(code), "well-formed XML"});
      return std::nullopt;
    }
    if (is_stopped_) return std::nullopt;
    return std::move(root_.children);
  }

 private:
  json::Place place() const {
    const auto line = static_cast<std::uint32_t>(XML_GetCurrentLineNumber(parser_.get()));
    const auto column = static_cast<std::uint32_t>(XML_GetCurrentColumnNumber(parser_.get()));
    const auto ahead = static_cast<std::uint32_t>(opening.size());
    if (line == 1) return {file_, lines_before_ + 1, columns_before_ + (column >= ahead ? column - ahead : 0) + 1, ""};
    return {file_, lines_before_ + line, column + 1, ""};
  }

  void stop(std::string found, std::string expected) {
    if (is_stopped_) return;
    is_stopped_ = true;
    diagnostics_.error(place(), "XML that is not read", {std::move(found), std::move(expected)});
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  static std::pair<std::string, std::string> parts(const std::string& name) {
    const std::size_t at = name.find(between);
    return at == std::string::npos ? std::pair(std::string(), name)
                                   : std::pair(name.substr(0, at), name.substr(at + 1));
  }

  void start(const std::string& name, const XML_Char** attributes) {
    if (open_.size() > max_xml_depth)
      return stop("more than " + std::to_string(max_xml_depth) + " elements within each other", "fewer");
    if (++elements_ > max_xml_elements)
      return stop("more than " + std::to_string(max_xml_elements) + " elements", "fewer");
    XmlElement element;
    std::tie(element.name_space, element.name) = parts(name);
    element.place = place();
    for (; *attributes != nullptr; attributes += 2) {
      auto [name_space, local] = parts(attributes[0]);
      element.attributes.push_back({std::move(name_space), std::move(local), attributes[1]});
    }
    element.declared = std::move(declared_);
    declared_.clear();
    open_.push_back(std::move(element));
  }

  void end() {
    if (is_stopped_ || open_.empty()) return;
    XmlElement element = std::move(open_.back());
    open_.pop_back();
    element.text = trimmed(element.text);
    if (open_.empty())
      root_ = std::move(element);
    else
      open_.back().children.push_back(std::move(element));
  }

  void characters(std::string_view data) {
    if (!open_.empty()) open_.back().text += data;
  }

  std::string_view text_;
  const std::string& file_;
  json::Diagnostics& diagnostics_;
  std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser_;
  std::vector<std::pair<std::string, std::string>> declared_;
  std::vector<XmlElement> open_;
  XmlElement root_;
  std::size_t elements_ = 0;
  std::uint32_t lines_before_ = 0, columns_before_ = 0;
  bool is_stopped_ = false;
};

}  // namespace

const XmlAttribute* XmlElement::attribute(std::string_view which) const {
  const auto found = std::ranges::find(attributes, which, &XmlAttribute::name);
  return found == attributes.end() ? nullptr : &*found;
}

std::optional<std::vector<XmlElement>> parse_xml(std::string_view text, const std::string& file,
                                                 json::Diagnostics& diagnostics) {
  return Parser(text, file, diagnostics).run();
}

std::string xml_escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

}  // namespace takt
