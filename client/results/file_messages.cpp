// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/file_parts.hpp"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <cstring>
#include <deque>
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
  if (!set(message, entry, value))
    throw Fault("has the unknown " + entry.name + " \"" + std::get<std::string>(value) + "\"");
}

/// Adds the rows of put_meanings for a message type and its lists.
void add_meanings(const std::string& where, const Descriptor& type, const v1::Units& units,
                  std::vector<std::string>& rows) {
  const auto add = [&](const std::string& at, const Descriptor& of) {
    for (const Entry& entry : entries_of(of))
      rows.insert(rows.end(), {at, entry.name, unit_of(units, entry.unit), entry.meaning});
  };
  add(where, type);
  for (const FieldDescriptor* list : lists_of(type))
    if (list->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE && !list->is_map())
      add(list->name(), *list->message_type());
}

Members members_of(const Types& types) {
  Members members;
  for (const Descriptor* type : types)
    for (const Entry& entry : entries_of(*type))
      members.push_back({entry.name, entry.type, entry.unit});
  return members;
}

template <class T>
void append(std::vector<std::byte>& records, const T& value) {
  const auto bytes = std::as_bytes(std::span(&value, 1));
  records.insert(records.end(), bytes.begin(), bytes.end());
}

/// Reads a value of a record, and returns where the next one begins.
template <class T>
const std::byte* take(const std::byte* from, T& value) {
  std::memcpy(&value, from, sizeof value);
  return from + sizeof value;
}
const std::byte* take(const std::byte* from, std::string& value) {
  const char* text = nullptr;
  from = take(from, text);
  if (text != nullptr) value = text;
  return from;
}

}  // namespace

/// Without members the entries are texts.
void Messages::put_list(const Handle& group, const std::string& name, const Members& members,
                        const std::vector<std::byte>& entries) {
  const hid_t type = members.empty() ? type_of(ValueType::text) : type_of(members);
  const auto known = _empty.find(type);
  if (entries.empty() && known != _empty.end()) return link(known->second, ".", group, name);
  Handle list =
      put_dataset(group, name, type, entries.data(), {entries.size() / H5Tget_size(type)});
  std::vector<std::string> units;
  for (const Member& member : members) units.push_back(unit_of(_units, member.unit));
  if (members.empty())
    hdf5::put(list, "units", std::string("-"));
  else
    hdf5::put(list, "units", units);
  if (entries.empty()) _empty.emplace(type, std::move(list));
}

void Messages::put(const Handle& group, const std::string& name, const Types& types,
                   const std::vector<const Message*>& messages) {
  std::vector<std::byte> records;
  std::deque<std::string> texts;
  for (const Message* message : messages)
    for (const Entry& entry : entries_of(*message->GetDescriptor())) {
      Value value = get(*message, entry);
      if (auto* const text = std::get_if<std::string>(&value))
        append(records, texts.emplace_back(std::move(*text)).c_str());
      else
        std::visit([&](const auto& number) { append(records, number); }, value);
    }
  put_list(group, name, members_of(types), records);
}

void Messages::put(const Handle& group, const std::string& name, std::span<const tables::Row> table,
                   const Arrays& arrays, const std::string& path) {
  Members members;
  std::vector<const Array*> columns;
  for (const tables::Row& row : table) {
    members.push_back({row.name, row.type, row.unit});
    const auto found = arrays.find(path + std::string(row.name));
    if (found != arrays.end()) columns.push_back(&found->second);
  }
  std::vector<std::byte> records;
  for (std::size_t i = 0; !columns.empty() && i < count_of(columns[0]->shape); ++i)
    for (const Array* column : columns) {
      const std::byte* const from = column->data.get() + i * bytes_of(column->type);
      records.insert(records.end(), from, from + bytes_of(column->type));
    }
  put_list(group, name, members, records);
}

void Messages::put(const Handle& group, const Message& message) {
  for (const Entry& entry : entries_of(*message.GetDescriptor()))
    std::visit([&](const auto& value) { hdf5::put(group, entry.name, value); },
               get(message, entry));
  for (const FieldDescriptor* list : lists_of(*message.GetDescriptor())) {
    if (list->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      put(group, list->name(), {list->message_type()}, items_of(message, *list));
      continue;
    }
    const std::vector<std::string> texts = texts_of(message, *list);
    std::vector<std::byte> entries;
    for (const std::string& text : texts) append(entries, text.c_str());
    put_list(group, list->name(), {}, entries);
  }
}

void get_messages(const Handle& group, const std::string& name, std::uint64_t budget,
                  const Types& types, const std::function<Message&()>& next) {
  get_list(group, name, type_of(members_of(types)), budget, [&](const std::byte* from) {
    for (const Descriptor* type : types) {
      Message& message = next();
      for (const Entry& entry : entries_of(*type)) {
        texts_and_numbers(entry.type, [&](auto value) {
          from = take(from, value);
          set_or_refuse(message, entry, value);
        });
      }
    }
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
  for (const FieldDescriptor* field : lists_of(*message.GetDescriptor())) {
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
      get_list(group, field->name(), type_of(ValueType::text), budget, [&](const std::byte* from) {
        std::string text;
        take(from, text);
        fields.AddString(&message, field, std::move(text));
      });
      continue;
    }
    get_messages(group, field->name(), budget, {field->message_type()},
                 [&]() -> Message& { return *fields.AddMessage(&message, field); });
  }
}

void put_meanings(const Handle& root, const v1::Units& units) {
  std::vector<std::string> rows;
  add_meanings("solver", *v1::Solver::descriptor(), units, rows);
  add_meanings("mesh", *v1::Mesh::descriptor(), units, rows);
  add_meanings("loads", *v1::LoadCaseAnswer::descriptor(), units, rows);
  add_meanings("stages", *v1::Stage::descriptor(), units, rows);
  add_meanings("sweep", *v1::SweepAnswer::descriptor(), units, rows);
  constexpr std::size_t columns = 4;
  std::vector<const char*> texts;
  texts.reserve(rows.size());
  for (const std::string& text : rows) texts.push_back(text.c_str());
  const Handle meanings = put_dataset(root, "meanings", type_of(ValueType::text), texts.data(),
                                      {rows.size() / columns, columns});
  put(meanings, "units", std::string("-"));
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
        put_dataset(group, name, type_of(array.type), array.data.get(), array.shape);
    put(dataset, "units", unit_of(units, row.unit));
    if (row.explained) put(dataset, "meaning", std::string(row.what));
  }
}

void get_arrays(const Handle& group, std::uint64_t budget, std::span<const tables::Row> table,
                Arrays& arrays, const std::string& path, Extents known) {
  for (const tables::Row& row : table) {
    const std::string name(row.name);
    if (row.may_be_missing() && !has(group, name)) continue;
    const Dataset dataset = open_array(group, name, type_of(row.type), budget, row.shape, known);
    // Of doubles, so that numbers of all types are aligned.
    const auto owner = std::make_shared<std::vector<double>>(
        (count_of(dataset.shape) * bytes_of(row.type) + sizeof(double) - 1) / sizeof(double));
    read_values(dataset, owner->data());
    arrays[path + name] = {
        row.type, dataset.shape, {owner, reinterpret_cast<const std::byte*>(owner->data())}};
  }
}

}  // namespace anticrack::results::hdf5
