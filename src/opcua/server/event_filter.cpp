#include "opcua/server/event_filter.hpp"

#include <algorithm>

#include "opcua/server/numeric_range.hpp"

namespace takt::opcua {
namespace {

constexpr std::size_t most_elements = 64;
constexpr std::size_t any_number = 1000;

struct OperatorInfo {
  FilterOperator id;
  std::size_t least;
  std::size_t most;
};
/// How many operands each takes. The others are Bad_FilterOperatorUnsupported.
constexpr OperatorInfo operators[] = {
    {FilterOperator::Equals, 2, 2},           {FilterOperator::IsNull, 1, 1},      {FilterOperator::GreaterThan, 2, 2},     {FilterOperator::LessThan, 2, 2},
    {FilterOperator::GreaterThanOrEqual, 2, 2}, {FilterOperator::LessThanOrEqual, 2, 2}, {FilterOperator::Not, 1, 1},       {FilterOperator::Between, 3, 3},
    {FilterOperator::InList, 2, any_number},  {FilterOperator::And, 2, 2},         {FilterOperator::Or, 2, 2},              {FilterOperator::OfType, 1, 1}};

const OperatorInfo* info_of(FilterOperator id) {
  const auto found = std::find_if(std::begin(operators), std::end(operators), [&](const OperatorInfo& each) { return each.id == id; });
  return found == std::end(operators) ? nullptr : found;
}

StatusCode check_clause(const SimpleAttributeOperand& clause, const AddressSpace& space) {
  if (space.find(clause.type_definition_id) == nullptr || !space.is_subtype(clause.type_definition_id, NodeId(ids::base_event_type))) {
    // ConditionType is not known here; clients ask for the id of a condition all the same, and get null.
    const bool is_condition_id = clause.browse_path.empty() && clause.attribute_id == static_cast<std::uint32_t>(AttributeId::NodeId);
    return is_condition_id ? StatusCode::Good : StatusCode::BadNodeIdUnknown;
  }
  if (clause.browse_path.empty()) return clause.attribute_id == static_cast<std::uint32_t>(AttributeId::NodeId) ? StatusCode::Good : StatusCode::BadAttributeIdInvalid;
  if (clause.attribute_id != static_cast<std::uint32_t>(AttributeId::Value)) return StatusCode::BadAttributeIdInvalid;
  if (Variant nothing; cut(nothing, clause.index_range) == StatusCode::BadIndexRangeInvalid) return StatusCode::BadIndexRangeInvalid;
  return is_event_field(path_of(clause.browse_path)) ? StatusCode::Good : StatusCode::BadNodeIdUnknown;
}

/// An operand is an element behind this one, a literal, or a field.
bool is_operand(const ExtensionObject& operand, std::size_t element, std::size_t elements) {
  if (const auto index = structure_in<ElementOperand>(operand)) return index->index > element && index->index < elements;
  return structure_in<LiteralOperand>(operand) || structure_in<SimpleAttributeOperand>(operand);
}

StatusCode check_element(const ContentFilterElement& element, std::size_t index, std::size_t elements) {
  const OperatorInfo* const wanted = info_of(element.filter_operator);
  if (wanted == nullptr) return StatusCode::BadFilterOperatorUnsupported;
  if (element.filter_operands.size() < wanted->least || element.filter_operands.size() > wanted->most) return StatusCode::BadFilterOperandInvalid;
  const bool are_sound = std::all_of(element.filter_operands.begin(), element.filter_operands.end(), [&](const auto& each) { return is_operand(each, index, elements); });
  return are_sound ? StatusCode::Good : StatusCode::BadFilterOperandInvalid;
}

Variant field_of(const SimpleAttributeOperand& clause, const Event& event) {
  const auto found = event.fields.find(path_of(clause.browse_path));
  if (found == event.fields.end()) return {};
  Variant value = found->second;
  return cut(value, clause.index_range) == StatusCode::Good ? value : Variant();
}

/// Asks a filter whose elements point behind themselves, so it ends; each operator asks at most `most_elements` others below it once.
class Question {
 public:
  Question(const ContentFilter& filter, const Event& event, const AddressSpace& space) : filter_(filter), event_(event), space_(space) {}

  bool holds(std::size_t index) {
    if (++asked_ > most_asked) return false;
    const ContentFilterElement& element = filter_.elements[index];
    const auto& operands = element.filter_operands;
    switch (element.filter_operator) {
      case FilterOperator::And: return truth(operands[0]) && truth(operands[1]);
      case FilterOperator::Or: return truth(operands[0]) || truth(operands[1]);
      case FilterOperator::Not: return !truth(operands[0]);
      case FilterOperator::IsNull: return value(operands[0]).is_null();
      case FilterOperator::OfType: return is_of_type(value(operands[0]));
      case FilterOperator::Equals: return are_equal(value(operands[0]), value(operands[1]));
      case FilterOperator::InList:
        return std::any_of(operands.begin() + 1, operands.end(), [&](const auto& each) { return are_equal(value(operands[0]), value(each)); });
      case FilterOperator::GreaterThan: return compare(operands, [](double a, double b) { return a > b; });
      case FilterOperator::LessThan: return compare(operands, [](double a, double b) { return a < b; });
      case FilterOperator::GreaterThanOrEqual: return compare(operands, [](double a, double b) { return a >= b; });
      case FilterOperator::LessThanOrEqual: return compare(operands, [](double a, double b) { return a <= b; });
      case FilterOperator::Between: {
        const auto at = number_in(value(operands[0])), least = number_in(value(operands[1])), most = number_in(value(operands[2]));
        return at && least && most && *at >= *least && *at <= *most;
      }
      default: return false;
    }
  }

 private:
  static constexpr std::size_t most_asked = 1000;

  bool truth(const ExtensionObject& operand) {
    const Variant of = value(operand);
    const bool* const flag = of.get<bool>();
    return flag != nullptr && *flag;
  }
  Variant value(const ExtensionObject& operand) {
    if (const auto element = structure_in<ElementOperand>(operand)) return Variant(holds(element->index));
    if (const auto literal = structure_in<LiteralOperand>(operand)) return literal->value;
    const auto field = structure_in<SimpleAttributeOperand>(operand);
    return field ? field_of(*field, event_) : Variant();
  }
  bool is_of_type(const Variant& type) const {
    const NodeId* const id = type.get<NodeId>();
    return id != nullptr && space_.is_subtype(event_.type, *id);
  }
  /// Numbers of different types are compared as numbers.
  static bool are_equal(const Variant& a, const Variant& b) {
    const auto x = number_in(a), y = number_in(b);
    return x && y ? *x == *y : a == b;
  }
  template <class Order>
  bool compare(const List<ExtensionObject>& operands, Order order) {
    const auto a = number_in(value(operands[0])), b = number_in(value(operands[1]));
    return a && b && order(*a, *b);
  }

  const ContentFilter& filter_;
  const Event& event_;
  const AddressSpace& space_;
  std::size_t asked_ = 0;
};

}  // namespace

FilterCheck check_filter(const EventFilter& filter, const AddressSpace& space) {
  FilterCheck check;
  std::size_t good = 0;
  for (const SimpleAttributeOperand& each : filter.select_clauses) {
    check.result.select_clause_results.push_back(check_clause(each, space));
    good += is_good(check.result.select_clause_results.back()) ? 1U : 0U;
  }
  check.has_errors = good < filter.select_clauses.size();
  check.is_usable = good > 0 && filter.where_clause.elements.size() <= most_elements;
  for (std::size_t i = 0; i < filter.where_clause.elements.size(); ++i) {
    const StatusCode status = check_element(filter.where_clause.elements[i], i, filter.where_clause.elements.size());
    check.result.where_clause_result.element_results.push_back({status, {}, {}});
    if (is_good(status)) continue;
    check.has_errors = true;
    check.is_usable = false;
  }
  return check;
}

List<Variant> selected_fields(const EventFilter& filter, const Event& event) {
  List<Variant> fields;
  for (const SimpleAttributeOperand& each : filter.select_clauses) fields.push_back(field_of(each, event));
  return fields;
}

bool lets_pass(const ContentFilter& filter, const Event& event, const AddressSpace& space) { return filter.elements.empty() || Question(filter, event, space).holds(0); }

}  // namespace takt::opcua
