// SPDX-License-Identifier: Apache-2.0
// Filters of monitored items (OPC 10000-4, 7.22 and 7.7).
#pragma once

#include "opcua/services/headers.hpp"

namespace takt::opcua {

enum class DataChangeTrigger : std::int32_t { Status, StatusValue, StatusValueTimestamp };
enum class FilterOperator : std::int32_t {
  Equals,
  IsNull,
  GreaterThan,
  LessThan,
  GreaterThanOrEqual,
  LessThanOrEqual,
  Like,
  Not,
  Between,
  InList,
  And,
  Or,
  Cast,
  InView,
  OfType,
  RelatedTo,
  BitwiseAnd,
  BitwiseOr
};

struct DataChangeFilter {
  static constexpr std::uint32_t encoding_id = 724;
  DataChangeTrigger trigger = DataChangeTrigger::StatusValue;
  std::uint32_t deadband_type = 0;
  double deadband_value = 0;
  static constexpr auto members() {
    return std::tuple(&DataChangeFilter::trigger, &DataChangeFilter::deadband_type, &DataChangeFilter::deadband_value);
  }
};

struct SimpleAttributeOperand {
  static constexpr std::uint32_t encoding_id = 603;
  NodeId type_definition_id;
  List<QualifiedName> browse_path;
  std::uint32_t attribute_id = 0;
  Text index_range;
  static constexpr auto members() {
    return std::tuple(&SimpleAttributeOperand::type_definition_id, &SimpleAttributeOperand::browse_path,
                      &SimpleAttributeOperand::attribute_id, &SimpleAttributeOperand::index_range);
  }
};

struct LiteralOperand {
  static constexpr std::uint32_t encoding_id = 597;
  Variant value;
  static constexpr auto members() { return std::tuple(&LiteralOperand::value); }
};

struct ElementOperand {
  static constexpr std::uint32_t encoding_id = 594;
  std::uint32_t index = 0;
  static constexpr auto members() { return std::tuple(&ElementOperand::index); }
};

struct ContentFilterElement {
  static constexpr std::uint32_t encoding_id = 585;
  FilterOperator filter_operator = FilterOperator::Equals;
  List<ExtensionObject> filter_operands;
  static constexpr auto members() {
    return std::tuple(&ContentFilterElement::filter_operator, &ContentFilterElement::filter_operands);
  }
};

struct ContentFilter {
  static constexpr std::uint32_t encoding_id = 588;
  List<ContentFilterElement> elements;
  static constexpr auto members() { return std::tuple(&ContentFilter::elements); }
};

struct EventFilter {
  static constexpr std::uint32_t encoding_id = 727;
  List<SimpleAttributeOperand> select_clauses;
  ContentFilter where_clause;
  static constexpr auto members() { return std::tuple(&EventFilter::select_clauses, &EventFilter::where_clause); }
};

struct ContentFilterElementResult {
  static constexpr std::uint32_t encoding_id = 606;
  StatusCode status_code = StatusCode::Good;
  List<StatusCode> operand_status_codes;
  List<DiagnosticInfo> operand_diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&ContentFilterElementResult::status_code, &ContentFilterElementResult::operand_status_codes,
                      &ContentFilterElementResult::operand_diagnostic_infos);
  }
};

struct ContentFilterResult {
  static constexpr std::uint32_t encoding_id = 609;
  List<ContentFilterElementResult> element_results;
  List<DiagnosticInfo> element_diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&ContentFilterResult::element_results, &ContentFilterResult::element_diagnostic_infos);
  }
};

struct EventFilterResult {
  static constexpr std::uint32_t encoding_id = 736;
  List<StatusCode> select_clause_results;
  List<DiagnosticInfo> select_clause_diagnostic_infos;
  ContentFilterResult where_clause_result;
  static constexpr auto members() {
    return std::tuple(&EventFilterResult::select_clause_results, &EventFilterResult::select_clause_diagnostic_infos,
                      &EventFilterResult::where_clause_result);
  }
};

}  // namespace takt::opcua
