func.func private @f()
func.func @g() {
  call @f() {rtsl.cheap} : () -> ()
  return
}
