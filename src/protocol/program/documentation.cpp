// SPDX-License-Identifier: Apache-2.0
#include "program/documentation.hpp"

#include "program/nested_machine.hpp"
#include "program/table.hpp"

namespace takt::program {
namespace {

std::string padded(std::string_view text, std::size_t width) {
  std::string result(text);
  if (result.size() < width) result.append(width - result.size(), ' ');
  return result;
}

void end_line(std::string& text) {
  text.erase(text.find_last_not_of(' ') + 1);
  text += '\n';
}

std::string node_id(std::uint16_t number) { return "i=" + std::to_string(number); }

/// "Reset, internal", "Start", "internal".
std::string causes_of(const Transition& transition) {
  std::string causes;
  for (const MethodInfo& method : methods)
    if (transition.causes.contains(method.method)) causes += (causes.empty() ? "" : ", ") + std::string(method.name);
  if (transition.internal) causes += causes.empty() ? "internal" : ", internal";
  return causes;
}

void add_states(std::string& text) {
  text += "States (OPC 10000-10, 5.2.3)\n";
  text += "  No.  State       NodeId\n";
  for (const StateInfo& state : states) {
    text += "  " + padded(std::to_string(number_of(state.state)), 5) + padded(state.name, 12) + node_id(state.node_id);
    end_line(text);
    if (state.state != init_machine.parent) continue;
    for (const Substate& substate : init_machine.substates) {
      text += "  " + padded(std::to_string(substate.number), 5) + "  ." + padded(substate.name, 9) +
              "(substate, distributed Programs)";
      end_line(text);
    }
  }
}

void add_transitions(std::string& text) {
  text += "\nTransitions (OPC 10000-10, 5.2.4)\n";
  text += "  No.  Transition          From       To         Caused by          NodeId\n";
  for (const Transition& transition : transitions) {
    text += "  " + padded(std::to_string(transition.number), 5) + padded(transition.name, 20) +
            padded(name_of(transition.from), 11) + padded(name_of(transition.to), 11) +
            padded(causes_of(transition), 19) + node_id(transition.node_id);
    end_line(text);
  }
}

void add_methods(std::string& text) {
  text += "\nMethods (OPC 10000-10, 5.2.7): the transition in each state, - where Executable is false\n  ";
  text += padded("Method", 10);
  for (const StateInfo& state : states) text += padded(state.name, 11);
  text += "NodeId\n";
  for (const MethodInfo& method : methods) {
    text += "  " + padded(method.name, 10);
    for (const StateInfo& state : states) {
      const Transition* const transition = transition_caused_by(method.method, state.state);
      text += padded(transition == nullptr ? "-" : std::to_string(transition->number), 11);
    }
    text += node_id(method.node_id);
    end_line(text);
  }
}

}  // namespace

std::string table_text() {
  std::string text;
  add_states(text);
  add_transitions(text);
  add_methods(text);
  return text;
}

std::string table_dot() {
  std::string text = "digraph Program {\n  rankdir=LR;\n  node [shape=box, style=rounded];\n";
  for (const StateInfo& state : states) {
    const std::string name(state.name);
    text += "  " + name + " [label=\"" + name + "\\n" + std::to_string(number_of(state.state));
    if (state.state == init_machine.parent)
      for (const Substate& substate : init_machine.substates)
        text += "\\n(" + std::string(substate.name) + " " + std::to_string(substate.number) + ")";
    text += "\"];\n";
  }
  for (const Transition& transition : transitions) {
    text += "  " + std::string(name_of(transition.from)) + " -> " + std::string(name_of(transition.to)) + " [label=\"" +
            std::to_string(transition.number) + ": " + causes_of(transition) + "\"";
    if (transition.causes == MethodSet{}) text += ", style=dashed";
    text += "];\n";
  }
  return text + "}\n";
}

}  // namespace takt::program
