// SQLite, as far as map files need it: a connection, statements, and a transaction that a crash undoes.
//
// What a file holds is never trusted: a number that is missing, not finite or out of range is an InputError that names
// the file. A file that cannot be written is a std::runtime_error, as of write_file().
#ifndef TEXTSLAM_MAP_FILE_DATABASE_HPP
#define TEXTSLAM_MAP_FILE_DATABASE_HPP

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace textslam {

enum class Access {
  read,   ///< The file stays as it is.
  write,  ///< It is made where there is none.
};

class Database {
 public:
  /// Opens the file; Access::read of a save that was killed restores the map from before it first.
  Database(const std::string& path, Access access);

  /// Runs one or more statements without results.
  void execute(const std::string& sql);
  /// The first column of the first row.
  std::int64_t integer(const std::string& sql);
  /// Goes on in a copy of the file in memory: what is changed from here on is never written.
  void continue_in_memory();

  /// Throws what the last call on the connection reported.
  [[noreturn]] void fail() const;
  /// Throws an InputError with this message.
  [[noreturn]] void refuse(const std::string& message) const;
  const std::string& path() const { return path_; }
  sqlite3* handle() const { return connection_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* connection) const;
  };
  std::string path_;
  Access access_;
  std::unique_ptr<sqlite3, Close> connection_;
};

class Statement {
 public:
  Statement(Database& database, const std::string& sql);

  /// Binds the values to the parameters in their order and runs to the end. A double that is not finite becomes NULL.
  template <class... Values>
  void run(const Values&... values) {
    bind_all(values...);
    while (next()) {
    }
  }
  template <class... Values>
  void bind_all(const Values&... values) {
    reset();
    [[maybe_unused]] int at = 0;  // without values
    (bind(++at, values), ...);
  }
  /// Goes to the next row; false after the last.
  bool next();
  /// Back to before the first row, without values.
  void reset();
  /// Values one by one, `at` from 1; what is not bound is NULL.
  void bind(int at, double value);
  void bind(int at, std::int64_t value);
  void bind(int at, int value) { bind(at, static_cast<std::int64_t>(value)); }
  void bind(int at, const std::string& value);
  void bind(int at, std::string_view bytes);
  void bind(int at, std::nullptr_t);

  /// Columns of the row, from 0.
  bool is_null(int column) const;
  double number(int column) const;                                                 ///< Finite.
  std::int64_t integer(int column, std::int64_t lowest, std::int64_t most) const;  ///< In this range.
  int index(int column, int most) const { return static_cast<int>(integer(column, 0, most)); }
  std::string text(int column) const;
  std::string_view bytes(int column) const;  ///< Until the next row.

 private:
  struct Finalise {
    void operator()(sqlite3_stmt* statement) const;
  };

  Database& database_;
  std::unique_ptr<sqlite3_stmt, Finalise> statement_;
};

/// From its making to commit(): all or nothing, whatever ends the program. It waits some seconds for another writer.
class Transaction {
 public:
  explicit Transaction(Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
  bool open_ = true;
};

}  // namespace textslam

#endif  // TEXTSLAM_MAP_FILE_DATABASE_HPP
