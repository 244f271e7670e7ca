" How APT programs are edited.
if exists('b:did_ftplugin')
  finish
endif
let b:did_ftplugin = 1

setlocal commentstring=$$\ %s
setlocal comments=:$$
setlocal iskeyword=@,48-57,_
setlocal nosmartindent

let b:undo_ftplugin = 'setlocal commentstring< comments< iskeyword< smartindent<'
