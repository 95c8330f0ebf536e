#include "signals/formats/file_kind.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include "signals/base/error.h"

namespace vibrissa::signals::formats {
namespace {

struct FileKind {
  std::string_view start;
  std::string_view what;       // it is ..., to do
  std::string_view extension;  // of the format that reads it; empty: none does
};

constexpr std::string_view zip_start{"PK\x03\x04", 4};

constexpr auto file_kinds = std::to_array<FileKind>({
    {"version https://git-lfs",
     "a pointer of Git LFS, not the recording itself; fetch it by 'git lfs pull'", ""},
    {"\x1f\x8b", "a gzip archive; unpack it first", ""},
    {"BZh", "a bzip2 archive; unpack it first", ""},
    {"7z\xBC\xAF", "a 7-Zip archive; unpack it first", ""},
    {"\x28\xB5\x2F\xFD", "a Zstandard archive; unpack it first", ""},
    {"Rar!", "a RAR archive; unpack it first", ""},
    {"TDSm", "a TDMS file of LabVIEW; export it as text (.lvm) or .mat", ""},
    {"\xD0\xCF\x11\xE0", "a spreadsheet or document of Office; save it as CSV", ""},
    {"%PDF", "a PDF document, not a recording", ""},
    {"\x89PNG", "a picture, not a recording", ""},
    {"\xFF\xD8\xFF", "a picture, not a recording", ""},
    {"SQLite format 3", "an SQLite database; export its table as CSV", ""},
    {"PAR1", "a Parquet file; export it as CSV", ""},
    {"\x89HDF\r\n\x1a\n", "an HDF5 file; name it .h5 (.mat for one of MATLAB 7.3)", ".h5"},
    {"MATLAB 5.0 MAT-file", "a MATLAB file; name it .mat", ".mat"},
    {"\x93NUMPY", "a NumPy array; name it .npy", ".npy"},
    {"RIFF", "a sound file; name it .wav", ".wav"},
});

// miniSEED: six digits, the quality of the data, a blank or a letter.
bool is_mini_seed(const std::string_view head) {
  return head.size() > 48 &&
         head.substr(0, 6).find_first_not_of("0123456789") == std::string_view::npos &&
         std::string_view("DRQM").find(head[6]) != std::string_view::npos && head[7] == ' ' &&
         head.find('\0') != std::string_view::npos;
}

// SEG-Y begins with lines of 80 characters in EBCDIC ("C 1") or ASCII.
bool is_seg_y(const std::string_view head) {
  return head.starts_with("\xC3\x40\xF1") || head.starts_with("C 1 CLIENT") ||
         head.starts_with("C01 CLIENT");
}

bool is_one_of(const std::string_view wanted, const std::initializer_list<std::string_view> all) {
  return std::find(all.begin(), all.end(), wanted) != all.end();
}

std::string archive_words(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  if (ending == ".npz") return "an archive of NumPy arrays (.npz); save each array as .npy";
  if (is_one_of(ending, {".xlsx", ".xlsm", ".ods"})) return "a spreadsheet; save it as CSV";
  return "a zip archive (or a spreadsheet); unpack it, or save the sheet as CSV";
}

}  // namespace

void refuse_other_kinds(const std::filesystem::path& file, const std::string& extension) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return;
  std::array<char, 512> bytes{};
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), bytes.size());
  const std::string_view head(bytes.data(), static_cast<std::size_t>(in.gcount()));
  const auto refuse = [&](const std::string_view what) {
    throw UserError(file.string() + ": this is " + std::string(what));
  };
  if (head.starts_with(zip_start)) refuse(archive_words(file));
  if (is_mini_seed(head)) refuse("a seismic record (miniSEED); export it as text, with its rate");
  if (is_seg_y(head)) refuse("a seismic record (SEG-Y); export it as text, with its rate");
  for (const FileKind& kind : file_kinds) {
    const bool is_mat_7_3 = kind.extension == ".h5" && extension == ".mat";
    if (head.starts_with(kind.start) && kind.extension != extension && !is_mat_7_3)
      refuse(kind.what);
  }
}

}  // namespace vibrissa::signals::formats
