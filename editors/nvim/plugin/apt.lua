-- Loaded once at start: file types and commands. The server starts with the first APT buffer.
if vim.g.loaded_apt then
  return
end
vim.g.loaded_apt = true
if vim.fn.has('nvim-0.7.2') == 0 then
  vim.api.nvim_err_writeln('apt: Neovim 0.7.2 or newer is needed')
  return
end
require('apt.filetype').register()
require('apt.commands').register()
require('apt.client').register()
