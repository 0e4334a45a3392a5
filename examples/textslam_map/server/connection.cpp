#include "textslam_map/server/connection.hpp"

#include <libpq-fe.h>

#include <array>
#include <cmath>
#include <cstring>

#include "io/input_error.hpp"

namespace textslam {
namespace {

constexpr std::size_t kChunk = 1 << 18;  // bytes sent at once
constexpr int kBinary = 1;

struct Clear {
  void operator()(PGresult* result) const { PQclear(result); }
};
using Result = std::unique_ptr<PGresult, Clear>;

// Messages of libpq have several lines, the first of which says what is wrong.
std::string first_line(const char* message) {
  std::string line = message ? message : "";
  line = line.substr(0, line.find('\n'));
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  return line.empty() ? "the connection was lost" : line;
}

// Of pg_type, which no version changes.
Oid type_of(Kind kind) {
  switch (kind) {
    case Kind::integer: return 20;
    case Kind::real: return 701;
    case Kind::text: return 25;
    default: return 17;
  }
}

const char* name_of(Kind kind) {
  constexpr std::array<const char*, 4> kNames = {"bigint", "double precision", "text", "bytea"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace

bool ServerRow::is_null(int column) const { return PQgetisnull(result_, row_, column) == 1; }

std::uint64_t ServerRow::word(int column) const {
  if (is_null(column) || PQgetlength(result_, row_, column) != 8) refuse(column, "is missing");
  const char* bytes = PQgetvalue(result_, row_, column);
  std::uint64_t word = 0;
  for (int i = 0; i < 8; ++i) word = word << 8 | static_cast<unsigned char>(bytes[i]);
  return word;
}

std::int64_t ServerRow::integer(int column) const { return static_cast<std::int64_t>(word(column)); }

double ServerRow::real(int column) const {
  const std::uint64_t bits = word(column);
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  if (!std::isfinite(value)) refuse(column, "is not finite");
  return value;
}

std::string_view ServerRow::bytes(int column) const {
  if (is_null(column)) refuse(column, "is missing");
  return {PQgetvalue(result_, row_, column), static_cast<std::size_t>(PQgetlength(result_, row_, column))};
}

void ServerRow::refuse(int column, const std::string& what) const {
  throw InputError(server_, 0, std::string("damaged: ") + PQfname(result_, column) + " " + what);
}

void Connection::Close::operator()(pg_conn* connection) const { PQfinish(connection); }

Connection::Connection(const std::string& database) : name_("server") {
  // What the string says comes later, and counts.
  const char* const keys[] = {"connect_timeout", "fallback_application_name", "dbname", "client_encoding", nullptr};
  const char* const values[] = {"10", "textslam-map", database.c_str(), "UTF8", nullptr};
  connection_.reset(PQconnectdbParams(keys, values, 1));
  if (!connection_) refuse("out of memory");
  if (PQstatus(connection_.get()) != CONNECTION_OK) fail();
  name_ = std::string("server, database ") + PQdb(connection_.get());
  // Notices are not for whoever calls the program.
  PQsetNoticeProcessor(
      connection_.get(), [](void*, const char*) {}, nullptr);
  // Another writer is waited for, but not for ever, and the server finds out soon where one is gone.
  run("set lock_timeout = '10min'");
  run("set tcp_keepalives_idle = 60");
}

void Connection::refuse(const std::string& message) const { throw InputError(name_, 0, message); }

void Connection::fail() const { refuse(first_line(PQerrorMessage(connection_.get()))); }

void Connection::fail(const PGresult* result) const {
  const char* message = PQresultErrorField(result, PG_DIAG_MESSAGE_PRIMARY);
  if (!message) fail();
  refuse(first_line(message));
}

void Connection::send(const std::string& sql, const std::vector<std::string>& parameters, bool binary) {
  std::vector<const char*> values;
  for (const std::string& parameter : parameters) values.push_back(parameter.c_str());
  if (PQsendQueryParams(connection_.get(), sql.c_str(), static_cast<int>(values.size()), nullptr, values.data(),
                        nullptr, nullptr, binary ? kBinary : 0) != 1)
    fail();
}

std::int64_t Connection::run(const std::string& sql, const std::vector<std::string>& parameters) {
  send(sql, parameters, false);
  std::int64_t changed = 0;
  while (const Result result{PQgetResult(connection_.get())}) {
    const ExecStatusType status = PQresultStatus(result.get());
    if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK && status != PGRES_EMPTY_QUERY) fail(result.get());
    changed = std::strtoll(PQcmdTuples(result.get()), nullptr, 10);
  }
  return changed;
}

void Connection::rows(const std::string& sql, const std::vector<std::string>& parameters,
                      const std::vector<Kind>& kinds, const std::function<void(const ServerRow&)>& take) {
  send(sql, parameters, true);
  PQsetSingleRowMode(connection_.get());
  while (const Result result{PQgetResult(connection_.get())}) {
    const ExecStatusType status = PQresultStatus(result.get());
    if (status != PGRES_SINGLE_TUPLE && status != PGRES_TUPLES_OK) fail(result.get());
    for (std::size_t i = 0; i < kinds.size(); ++i)
      if (PQftype(result.get(), static_cast<int>(i)) != type_of(kinds[i]))
        refuse(std::string("foreign tables: the type of ") + PQfname(result.get(), static_cast<int>(i)) + " is not " +
               name_of(kinds[i]));
    for (int row = 0; row < PQntuples(result.get()); ++row) take(ServerRow(result.get(), row, name_));
  }
}

std::optional<std::int64_t> Connection::integer(const std::string& sql, const std::vector<std::string>& parameters) {
  std::optional<std::int64_t> found;
  rows(sql, parameters, {Kind::integer}, [&](const ServerRow& row) {
    if (!found && !row.is_null(0)) found = row.integer(0);
  });
  return found;
}

CopyIn::CopyIn(Connection& connection, const std::string& target) : connection_(connection) {
  connection.send("copy " + target + " from stdin (format binary)", {}, false);
  const Result result{PQgetResult(connection.connection_.get())};
  if (PQresultStatus(result.get()) != PGRES_COPY_IN) connection.fail(result.get());
  buffer_.assign("PGCOPY\n\377\r\n\0\0\0\0\0\0\0\0\0", 19);
}

void CopyIn::put(std::uint64_t value, int size) {
  for (int shift = 8 * (size - 1); shift >= 0; shift -= 8) buffer_.push_back(static_cast<char>(value >> shift & 0xff));
}

void CopyIn::flush() {
  if (PQputCopyData(connection_.connection_.get(), buffer_.data(), static_cast<int>(buffer_.size())) != 1)
    connection_.fail();
  buffer_.clear();
}

void CopyIn::begin_row(std::size_t columns) {
  if (buffer_.size() > kChunk) flush();
  put(columns, 2);
}

void CopyIn::null() { put(0xffffffff, 4); }

void CopyIn::integer(std::int64_t value) {
  put(8, 4);
  put(static_cast<std::uint64_t>(value), 8);
}

void CopyIn::real(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  put(8, 4);
  put(bits, 8);
}

void CopyIn::bytes(std::string_view value) {
  put(value.size(), 4);
  buffer_.append(value);
}

void CopyIn::finish() {
  put(0xffff, 2);
  flush();
  if (PQputCopyEnd(connection_.connection_.get(), nullptr) != 1) connection_.fail();
  while (const Result result{PQgetResult(connection_.connection_.get())})
    if (PQresultStatus(result.get()) != PGRES_COMMAND_OK) connection_.fail(result.get());
}

ServerTransaction::ServerTransaction(Connection& connection, const std::string& kind) : connection_(connection) {
  connection.run("begin " + kind);
}

ServerTransaction::~ServerTransaction() {
  if (!open_) return;
  try {
    connection_.run("rollback");
  } catch (const InputError&) {  // the connection is broken, so the server undoes it
  }
}

void ServerTransaction::commit() {
  connection_.run("commit");
  open_ = false;
}

}  // namespace textslam
