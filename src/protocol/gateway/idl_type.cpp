// SPDX-License-Identifier: Apache-2.0
#include "gateway/idl_type.hpp"

namespace takt::gateway {

std::string text_of(const IdlMember& member) {
  std::string text(info(member.kind).name);
  if (member.string_bound != 0) text += "<" + std::to_string(member.string_bound) + ">";
  switch (member.collection) {
    case IdlCollection::none:
      break;
    case IdlCollection::array:
      text += "[" + std::to_string(member.length) + "]";
      break;
    case IdlCollection::sequence:
      text = "sequence<" + text + (member.length != 0 ? ", " + std::to_string(member.length) : "") + ">";
      break;
  }
  return text;
}

}  // namespace takt::gateway
