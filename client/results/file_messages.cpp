// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/file_parts.hpp"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <google/protobuf/reflection.h>

#include <variant>

namespace anticrack::results::hdf5 {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

constexpr auto texts_and_numbers = [](ValueType type, const auto& use) {
  switch (type) {
    case ValueType::float64:
      return use(double{});
    case ValueType::int32:
      return use(std::int32_t{});
    case ValueType::int64:
      return use(std::int64_t{});
    default:
      return use(std::string{});
  }
};

void set_or_refuse(Message& message, const Entry& entry, const Value& value) {
  if (set(message, entry, value)) return;
  throw Fault("attribute " + entry.name + " is the unknown " + entry.name + " \"" +
              std::get<std::string>(value) + "\"");
}

/// Calls visit(field) for each list of a message type.
template <class Visit>
void for_each_list(const Descriptor& type, const Visit& visit) {
  for (int i = 0; i < type.field_count(); ++i)
    if (type.field(i)->is_repeated()) visit(type.field(i));
}

/// Adds the rows of put_meanings for a message type and its lists.
void add_meanings(const std::string& where, const Descriptor& type, const v1::Units& units,
                  std::vector<std::string>& rows) {
  const auto add = [&](const std::string& at, const Descriptor& of) {
    for (const Entry& entry : entries_of(of))
      rows.insert(rows.end(), {at, entry.name, unit_of(units, entry.unit), entry.meaning});
  };
  add(where, type);
  for_each_list(type, [&](const FieldDescriptor* field) {
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE && !field->is_map())
      add(field->name(), *field->message_type());
  });
}

/// Writes a list of a message; returns its dataset or group.
Handle put_list(const Handle& group, const v1::Units& units, const Message& message,
                const FieldDescriptor& field, int count) {
  const Reflection& fields = *message.GetReflection();
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
    const auto texts = fields.GetRepeatedFieldRef<std::string>(message, &field);
    const std::vector<std::string> values(texts.begin(), texts.end());
    return put_array(group, field.name(), ValueType::text, values.data(), {values.size()});
  }
  std::vector<const Message*> items;
  items.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) items.push_back(&fields.GetRepeatedMessage(message, &field, i));
  const Descriptor& type = *field.message_type();
  Handle columns =
      create_group(group, field.name(), static_cast<unsigned>(entries_of(type).size()));
  put_columns(columns, units, type, items);
  return columns;
}

}  // namespace

void put_columns(const Handle& group, const v1::Units& units, const Descriptor& type,
                 const std::vector<const Message*>& messages) {
  for (const Entry& entry : entries_of(type)) {
    texts_and_numbers(entry.type, [&](auto empty) {
      using T = decltype(empty);
      std::vector<T> column;
      column.reserve(messages.size());
      for (const Message* message : messages) column.push_back(std::get<T>(get(*message, entry)));
      put_array(group, entry.name, entry.type, column.data(), {column.size()},
                unit_of(units, entry.unit));
    });
  }
}

void get_columns(const Handle& group, std::uint64_t budget, const std::string& what,
                 const Descriptor& type, std::optional<std::size_t>& length,
                 const std::function<Message&(std::size_t)>& at) {
  constexpr std::size_t least_bytes = 64;  // that a message takes in memory
  for (const Entry& entry : entries_of(type)) {
    texts_and_numbers(entry.type, [&](auto empty) {
      const auto column =
          get_list<decltype(empty)>(group, entry.name, budget / least_bytes * bytes_of(entry.type));
      if (column.size() != length.value_or(column.size()))
        throw Fault(what + " has datasets of different lengths");
      length = column.size();
      for (std::size_t i = 0; i < column.size(); ++i) set_or_refuse(at(i), entry, column[i]);
    });
  }
}

void Messages::put(const Handle& group, const Message& message) {
  for (const Entry& entry : entries_of(*message.GetDescriptor()))
    std::visit([&](const auto& value) { hdf5::put(group, entry.name, value); },
               get(message, entry));
  const Reflection& fields = *message.GetReflection();
  for_each_list(*message.GetDescriptor(), [&](const FieldDescriptor* field) {
    const int count = fields.FieldSize(message, field);
    const auto known = _empty.find(field);
    if (count == 0 && known != _empty.end()) return link(known->second, ".", group, field->name());
    Handle list = put_list(group, _units, message, *field, count);
    if (count == 0) _empty.emplace(field, std::move(list));
  });
}

void get_message(const Handle& group, std::uint64_t budget, Message& message) {
  for (const Entry& entry : entries_of(*message.GetDescriptor())) {
    texts_and_numbers(entry.type, [&](auto value) {
      get(group, entry.name, value);
      set_or_refuse(message, entry, value);
    });
  }
  const Reflection& fields = *message.GetReflection();
  for_each_list(*message.GetDescriptor(), [&](const FieldDescriptor* field) {
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
      for (std::string& text : get_list<std::string>(group, field->name(), budget))
        fields.AddString(&message, field, std::move(text));
      return;
    }
    std::optional<std::size_t> length;
    get_columns(open_group(group, field->name()), budget, field->name(), *field->message_type(),
                length, [&](std::size_t i) -> Message& {
                  return static_cast<int>(i) < fields.FieldSize(message, field)
                             ? *fields.MutableRepeatedMessage(&message, field, static_cast<int>(i))
                             : *fields.AddMessage(&message, field);
                });
  });
}

void put_meanings(const Handle& root, const v1::Units& units) {
  std::vector<std::string> rows;
  add_meanings("solver", *v1::Solver::descriptor(), units, rows);
  add_meanings("mesh", *v1::Mesh::descriptor(), units, rows);
  add_meanings("loads", *v1::LoadCaseAnswer::descriptor(), units, rows);
  add_meanings("stages", *v1::Stage::descriptor(), units, rows);
  add_meanings("sweep", *v1::SweepAnswer::descriptor(), units, rows);
  constexpr std::size_t columns = 4;
  put_array(root, "meanings", ValueType::text, rows.data(), {rows.size() / columns, columns});
}

void put_arrays(const Handle& group, const v1::Units& units, std::span<const tables::Row> table,
                const Arrays& all, const std::string& path) {
  for (const tables::Row& row : table) {
    const std::string name(row.name);
    const auto found = all.find(path + name);
    Array array = found == all.end() ? Array{row.type} : found->second;
    if (const std::size_t columns = arrays::columns_of(row.shape);
        found == all.end() && columns != 0)
      array.shape.push_back(columns);
    if (count_of(array.shape) == 0 && row.may_be_missing()) continue;
    const Handle dataset =
        put_array(group, name, array.type, array.data.get(), array.shape, unit_of(units, row.unit));
    if (row.explained) put(dataset, "meaning", std::string(row.what));
  }
}

void get_arrays(const Handle& group, std::uint64_t budget, std::span<const tables::Row> table,
                Arrays& arrays, const std::string& path, Extents known) {
  for (const tables::Row& row : table) {
    const std::string name(row.name);
    if (row.may_be_missing() && !has(group, name)) continue;
    const Dataset dataset = open_array(group, name, row.type, budget, row.shape, known);
    // Of doubles, so that numbers of all types are aligned.
    const auto owner = std::make_shared<std::vector<double>>(
        (count_of(dataset.shape) * bytes_of(row.type) + sizeof(double) - 1) / sizeof(double));
    read_values(dataset, owner->data());
    arrays[path + name] = {
        row.type, dataset.shape, {owner, reinterpret_cast<const std::byte*>(owner->data())}};
  }
}

}  // namespace anticrack::results::hdf5
