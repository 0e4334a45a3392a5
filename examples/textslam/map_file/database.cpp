#include "textslam/map_file/database.hpp"

#include <sqlite3.h>

#include <cmath>
#include <stdexcept>

#include "io/input_error.hpp"

namespace textslam {
namespace {

constexpr int kPatienceMs = 5000;  // for another writer

sqlite3* open(const std::string& path, int flags, int* code) {
  sqlite3* connection = nullptr;
  *code = sqlite3_open_v2(path.c_str(), &connection, flags, nullptr);
  sqlite3_extended_result_codes(connection, 1);
  sqlite3_busy_timeout(connection, kPatienceMs);
  return connection;
}

// Whether the file says so by itself, and not for lack of rights.
bool has_unfinished_save(sqlite3* connection) {
  sqlite3_exec(connection, "select count(*) from sqlite_master", nullptr, nullptr, nullptr);
  const int code = sqlite3_extended_errcode(connection);
  return code == SQLITE_READONLY_ROLLBACK || code == SQLITE_READONLY_RECOVERY;
}

bool is_failed_write(int code) {
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
    case SQLITE_READONLY:
    case SQLITE_IOERR:
    case SQLITE_FULL:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM: return true;
    default: return false;
  }
}

}  // namespace

void Database::Close::operator()(sqlite3* connection) const { sqlite3_close_v2(connection); }

Database::Database(const std::string& path, Access access) : path_(path), access_(access) {
  int code = SQLITE_OK;
  const bool reads = access == Access::read;
  const int flags = reads ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  connection_.reset(open(path, flags, &code));
  if (code != SQLITE_OK) fail();
  if (reads && has_unfinished_save(connection_.get())) {
    // Whoever opens it for writing undoes the save.
    connection_.reset(open(path, SQLITE_OPEN_READWRITE, &code));
    if (code != SQLITE_OK) fail();
    execute("select count(*) from sqlite_master");
    connection_.reset(open(path, SQLITE_OPEN_READONLY, &code));
    if (code != SQLITE_OK) fail();
  }
  // A file that somebody made may hold definitions that do harm.
  sqlite3_db_config(connection_.get(), SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(connection_.get(), SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  execute("pragma foreign_keys = on; pragma cell_size_check = on");
}

void Database::continue_in_memory() {
  int code = SQLITE_OK;
  std::unique_ptr<sqlite3, Close> copy(open(":memory:", SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, &code));
  sqlite3_backup* backup = sqlite3_backup_init(copy.get(), "main", connection_.get(), "main");
  if (backup) sqlite3_backup_step(backup, -1);
  if (!backup || sqlite3_backup_finish(backup) != SQLITE_OK) fail();
  connection_ = std::move(copy);
}

void Database::execute(const std::string& sql) {
  if (sqlite3_exec(handle(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

std::int64_t Database::integer(const std::string& sql) {
  Statement statement(*this, sql);
  if (!statement.next()) refuse("'" + sql + "' has no answer");
  return statement.integer(0, INT64_MIN, INT64_MAX);
}

void Database::fail() const {
  const std::string reason = connection_ ? sqlite3_errmsg(handle()) : "out of memory";
  const int code = connection_ ? sqlite3_errcode(handle()) : SQLITE_NOMEM;
  if (is_failed_write(code) && access_ == Access::write) throw std::runtime_error(path_ + ": cannot write: " + reason);
  refuse(code == SQLITE_NOTADB ? "no map of textslam: not an SQLite database" : reason);
}

void Database::refuse(const std::string& message) const { throw InputError(path_, 0, message); }

void Statement::Finalise::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Statement::Statement(Database& database, const std::string& sql) : database_(database) {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(database.handle(), sql.data(), static_cast<int>(sql.size()), &statement, nullptr);
  statement_.reset(statement);
  if (code != SQLITE_OK) database.fail();
}

bool Statement::next() {
  const int code = sqlite3_step(statement_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) database_.fail();
  return code == SQLITE_ROW;
}

void Statement::reset() {
  sqlite3_reset(statement_.get());
  sqlite3_clear_bindings(statement_.get());
}

void Statement::bind(int at, double value) {
  if (std::isfinite(value)) sqlite3_bind_double(statement_.get(), at, value);
}

void Statement::bind(int at, std::int64_t value) { sqlite3_bind_int64(statement_.get(), at, value); }

void Statement::bind(int at, const std::string& value) {
  sqlite3_bind_text64(statement_.get(), at, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
}

void Statement::bind(int at, std::string_view bytes) {
  sqlite3_bind_blob64(statement_.get(), at, bytes.data(), bytes.size(), SQLITE_TRANSIENT);
}

void Statement::bind(int at, std::nullptr_t) { sqlite3_bind_null(statement_.get(), at); }

bool Statement::is_null(int column) const { return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL; }

double Statement::number(int column) const {
  const int type = sqlite3_column_type(statement_.get(), column);
  const double value = sqlite3_column_double(statement_.get(), column);
  if ((type == SQLITE_FLOAT || type == SQLITE_INTEGER) && std::isfinite(value)) return value;
  database_.refuse(std::string("damaged: ") + sqlite3_column_name(statement_.get(), column) +
                   " should be a finite number");
}

std::int64_t Statement::integer(int column, std::int64_t lowest, std::int64_t most) const {
  const std::int64_t value = sqlite3_column_int64(statement_.get(), column);
  if (sqlite3_column_type(statement_.get(), column) == SQLITE_INTEGER && value >= lowest && value <= most) return value;
  database_.refuse(std::string("damaged: ") + sqlite3_column_name(statement_.get(), column) + " is out of range");
}

std::string Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return text ? std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))) : "";
}

std::string_view Statement::bytes(int column) const {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
  return bytes ? std::string_view(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)))
               : std::string_view();
}

// It holds the lock of writers from here on, so that what it reads is what it replaces.
Transaction::Transaction(Database& database) : database_(database) { database.execute("begin immediate"); }

Transaction::~Transaction() {
  if (open_) sqlite3_exec(database_.handle(), "rollback", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
  database_.execute("commit");
  open_ = false;
}

}  // namespace textslam
