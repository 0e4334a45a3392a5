// PostgreSQL, as far as maps on a server need it: a connection, queries with typed rows, COPY in, and a transaction.
//
// Whatever the server or the network refuses is an InputError with the first line of what was said; it names the
// server without the connection string, which may hold a password. What a server holds is never trusted: a column of
// another type than asked for, or a number that is not finite, is an InputError too.
#ifndef TEXTSLAM_MAP_SERVER_CONNECTION_HPP
#define TEXTSLAM_MAP_SERVER_CONNECTION_HPP

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct pg_conn;
struct pg_result;

namespace textslam {

/// The kinds of values that maps are made of, on the server: bigint, double precision, text, bytea.
enum class Kind { integer, real, text, bytes };

/// A row of a result, until the next one. Columns count from 0.
class ServerRow {
 public:
  ServerRow(const pg_result* result, int row, const std::string& server)
      : result_(result), row_(row), server_(server) {}
  bool is_null(int column) const;
  std::int64_t integer(int column) const;
  double real(int column) const;  ///< Finite.
  std::string_view bytes(int column) const;
  std::string text(int column) const { return std::string(bytes(column)); }

 private:
  std::uint64_t word(int column) const;
  [[noreturn]] void refuse(int column, const std::string& what) const;

  const pg_result* result_;
  int row_;
  const std::string& server_;
};

class Connection {
 public:
  /// Connects, as libpq does by a connection string: postgresql://..., key=value pairs, or the name of a database.
  explicit Connection(const std::string& database);

  /// Runs one statement; $1, $2, ... are the parameters, as text. Returns the number of rows that it changed.
  std::int64_t run(const std::string& sql, const std::vector<std::string>& parameters = {});
  /// The same, giving each row as it comes. `kinds`: the types that its columns have to have.
  void rows(const std::string& sql, const std::vector<std::string>& parameters, const std::vector<Kind>& kinds,
            const std::function<void(const ServerRow&)>& take);
  /// The first column of the first row, an integer; empty: there is no row, or it is null.
  std::optional<std::int64_t> integer(const std::string& sql, const std::vector<std::string>& parameters = {});

  [[noreturn]] void refuse(const std::string& message) const;
  const std::string& name() const { return name_; }  ///< For messages.

 private:
  friend class CopyIn;
  struct Close {
    void operator()(pg_conn* connection) const;
  };
  [[noreturn]] void fail() const;
  [[noreturn]] void fail(const pg_result* result) const;
  void send(const std::string& sql, const std::vector<std::string>& parameters, bool binary);

  std::string name_;
  std::unique_ptr<pg_conn, Close> connection_;
};

/// Rows into a table by COPY in its binary format, which keeps every bit.
class CopyIn {
 public:
  /// `target` is a table with its columns, as COPY has it.
  CopyIn(Connection& connection, const std::string& target);
  void begin_row(std::size_t columns);
  void null();
  void integer(std::int64_t value);
  void real(double value);
  void bytes(std::string_view value);
  /// Everything is in the table of this transaction. Without it nothing is: the connection is of no use any more.
  void finish();

 private:
  void put(std::uint64_t value, int size);
  void flush();

  Connection& connection_;
  std::string buffer_;
};

/// From its making to commit(): all or nothing, whatever ends the program.
class ServerTransaction {
 public:
  /// `kind` follows BEGIN.
  explicit ServerTransaction(Connection& connection, const std::string& kind = "");
  ~ServerTransaction();
  ServerTransaction(const ServerTransaction&) = delete;
  ServerTransaction& operator=(const ServerTransaction&) = delete;
  void commit();

 private:
  Connection& connection_;
  bool open_ = true;
};

}  // namespace textslam

#endif  // TEXTSLAM_MAP_SERVER_CONNECTION_HPP
